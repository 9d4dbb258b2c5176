// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "common/error.h"
#include "mesh/gmsh_mesher.h"

namespace knead::tools {
namespace {

constexpr int kLinearTetrahedron = 4;  // gmsh's element type

/// A tetrahedron as gmsh gives it.
struct TaggedTetrahedron {
    std::size_t tag;
    std::array<std::size_t, 4> nodes;
    int volume;  ///< tag of the gmsh volume
};

/// Positions 0 .. n-1 ordered by their value.
std::vector<std::size_t> order_by(const std::vector<std::size_t>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    return order;
}

/// Fills nodes in the order of their tags; returns the sorted tags.
std::vector<std::size_t> extract_nodes(RawMesh& mesh, ExtractNodes which) {
    std::vector<std::size_t> tags;
    std::vector<double> coordinates;
    std::vector<double> unused;
    const bool all = which == ExtractNodes::all;
    gmsh::model::mesh::getNodes(tags, coordinates, unused, all ? -1 : 3, -1, !all, false);
    std::vector<std::size_t> sorted;
    for (const std::size_t i : order_by(tags)) {
        if (!sorted.empty() && sorted.back() == tags[i]) continue;
        sorted.push_back(tags[i]);
        mesh.nodes.push_back({coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]});
        mesh.node_numbers.push_back(static_cast<std::int64_t>(tags[i]));
    }
    return sorted;
}

std::string plural_name(int element_type) {
    std::string name;
    int dim = 0;
    int order = 0;
    int nodes = 0;
    int primary = 0;
    std::vector<double> coordinates;
    gmsh::model::mesh::getElementProperties(element_type, name, dim, order, nodes, coordinates, primary);
    return "\"" + name + "\"";
}

std::vector<TaggedTetrahedron> extract_tetrahedra(RawMesh& mesh) {
    std::vector<TaggedTetrahedron> tetrahedra;
    std::map<int, std::size_t> others;
    gmsh::vectorpair entities;
    gmsh::model::getEntities(entities);
    for (const auto& [dim, tag] : entities) {
        std::vector<int> types;
        std::vector<std::vector<std::size_t>> elements;
        std::vector<std::vector<std::size_t>> nodes;
        gmsh::model::mesh::getElements(types, elements, nodes, dim, tag);
        for (std::size_t i = 0; i < types.size(); ++i) {
            if (types[i] != kLinearTetrahedron) {
                others[types[i]] += elements[i].size();
                continue;
            }
            for (std::size_t e = 0; e < elements[i].size(); ++e)
                tetrahedra.push_back(
                    {elements[i][e],
                     {nodes[i][4 * e], nodes[i][4 * e + 1], nodes[i][4 * e + 2], nodes[i][4 * e + 3]},
                     tag});
        }
    }
    for (const auto& [type, count] : others)
        mesh.other_cells.emplace_back(plural_name(type), count);
    std::sort(tetrahedra.begin(), tetrahedra.end(),
              [](const auto& a, const auto& b) { return a.tag < b.tag; });
    return tetrahedra;
}

/// The name of the first physical group of a volume; empty when it is in none.
std::string group_name(int volume, RawMesh& mesh) {
    std::vector<int> groups;
    gmsh::model::getPhysicalGroupsForEntity(3, volume, groups);
    if (groups.empty()) return {};
    std::sort(groups.begin(), groups.end());
    if (groups.size() > 1)
        mesh.notes.push_back(
            {true, fmt::format("volume {} is in {} physical groups; the one with the smallest number is kept",
                               volume, groups.size())});
    std::string name;
    gmsh::model::getPhysicalName(3, groups[0], name);
    return name.empty() ? fmt::format("physical_{}", groups[0]) : name;
}

void extract_regions(const std::vector<TaggedTetrahedron>& tetrahedra, RawMesh& mesh) {
    std::map<int, std::string> name_of_volume;
    for (const TaggedTetrahedron& tetrahedron : tetrahedra)
        name_of_volume.try_emplace(tetrahedron.volume);
    bool any = false;
    for (auto& [volume, name] : name_of_volume) {
        name = group_name(volume, mesh);
        any = any || !name.empty();
    }
    if (!any) return;
    std::map<std::string, std::uint32_t> index_of;
    std::map<int, std::uint32_t> region_of_volume;
    for (auto& [volume, name] : name_of_volume) {
        if (name.empty()) name = "ungrouped";
        const auto [found, is_new] = index_of.try_emplace(name, static_cast<std::uint32_t>(index_of.size()));
        if (is_new) mesh.regions.names.push_back(name);
        region_of_volume[volume] = found->second;
    }
    for (const TaggedTetrahedron& tetrahedron : tetrahedra)
        mesh.regions.region_of_tetrahedron.push_back(region_of_volume[tetrahedron.volume]);
}

/// One value per tetrahedron from a view of ElementData; told when it does not cover all of them.
void extract_view(int view, RawMesh& mesh) {
    std::string name;
    gmsh::option::getString(fmt::format("View[{}].Name", gmsh::view::getIndex(view)), name);
    std::string kind;
    std::vector<std::size_t> tags;
    std::vector<std::vector<double>> data;
    double time = 0;
    int components = 0;
    gmsh::view::getModelData(view, 0, kind, tags, data, time, components);
    const auto leave_out = [&](const char* why) {
        mesh.notes.push_back({false, fmt::format("data \"{}\" left out: {}", name, why)});
    };
    if (kind != "ElementData" || components != 1) return leave_out("not one number per element");
    std::map<std::size_t, double> value_of;
    for (std::size_t i = 0; i < tags.size() && i < data.size(); ++i)
        if (!data[i].empty()) value_of[tags[i]] = data[i][0];
    CellArray array{name, {}};
    for (const std::int64_t tag : mesh.tetrahedron_numbers) {
        const auto found = value_of.find(static_cast<std::size_t>(tag));
        if (found == value_of.end()) return leave_out("some tetrahedra have no value");
        array.values.push_back(found->second);
    }
    mesh.cell_arrays.push_back(std::move(array));
}

}  // namespace

RawMesh extract_mesh(ExtractNodes which) {
    RawMesh mesh;
    mesh.numbering = "numbered as in the file";
    const std::vector<std::size_t> tags = extract_nodes(mesh, which);
    const std::vector<TaggedTetrahedron> tetrahedra = extract_tetrahedra(mesh);
    for (const TaggedTetrahedron& tetrahedron : tetrahedra) {
        std::array<std::int64_t, 4> nodes{};
        for (int i = 0; i < 4; ++i) {
            const auto found = std::lower_bound(tags.begin(), tags.end(), tetrahedron.nodes[i]);
            nodes[i] = found != tags.end() && *found == tetrahedron.nodes[i] ? found - tags.begin() : -1;
        }
        mesh.tetrahedra.push_back(nodes);
        mesh.tetrahedron_numbers.push_back(static_cast<std::int64_t>(tetrahedron.tag));
    }
    extract_regions(tetrahedra, mesh);
    std::vector<int> views;
    gmsh::view::getTags(views);
    for (const int view : views)
        extract_view(view, mesh);
    return mesh;
}

}  // namespace knead::tools
