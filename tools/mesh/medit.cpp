// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/medit.h"

#include <map>
#include <set>

#include "common/error.h"
#include "mesh/text_reader.h"

namespace knead::tools {
namespace {

/// Sections that are not kept: numbers per entry, and whether the entry is a cell that the user should hear
/// about.
struct SkippedSection {
    int words;
    bool is_cell;
};

const std::map<std::string_view, SkippedSection>& skipped_sections() {
    static const std::map<std::string_view, SkippedSection> kSections{{"Corners", {1, false}},
                                                                      {"RequiredVertices", {1, false}},
                                                                      {"Ridges", {1, false}},
                                                                      {"RequiredEdges", {1, false}},
                                                                      {"RequiredTriangles", {1, false}},
                                                                      {"Normals", {3, false}},
                                                                      {"Tangents", {3, false}},
                                                                      {"NormalAtVertices", {2, false}},
                                                                      {"TangentAtVertices", {2, false}},
                                                                      {"Edges", {3, true}},
                                                                      {"EdgesP2", {4, true}},
                                                                      {"Triangles", {4, true}},
                                                                      {"TrianglesP2", {7, true}},
                                                                      {"Quadrilaterals", {5, true}},
                                                                      {"TetrahedraP2", {11, true}},
                                                                      {"Hexahedra", {9, true}},
                                                                      {"Hexaedra", {9, true}},
                                                                      {"Prisms", {7, true}},
                                                                      {"Pyramids", {6, true}}};
    return kSections;
}

void read_vertices(TextReader& reader, RawMesh& mesh) {
    const std::size_t count = reader.count("the number of vertices");
    for (std::size_t i = 0; i < count; ++i) {
        Point point{};
        for (double& x : point)
            x = reader.number("a coordinate");
        reader.integer("a reference");
        mesh.nodes.push_back(point);
        mesh.node_numbers.push_back(static_cast<std::int64_t>(i) + 1);
    }
}

void read_tetrahedra(TextReader& reader, RawMesh& mesh, std::vector<std::int64_t>& references) {
    const std::size_t count = reader.count("the number of tetrahedra");
    for (std::size_t i = 0; i < count; ++i) {
        std::array<std::int64_t, 4> nodes{};
        for (std::int64_t& node : nodes)
            node = position_of(reader.integer("a vertex number"), 1);
        mesh.tetrahedra.push_back(nodes);
        mesh.tetrahedron_numbers.push_back(static_cast<std::int64_t>(i) + 1);
        references.push_back(reader.integer("a reference"));
    }
}

void make_regions(const std::vector<std::int64_t>& references, Regions& regions) {
    std::map<std::int64_t, std::uint32_t> index_of;
    for (const std::int64_t reference : references)
        index_of.try_emplace(reference, 0);
    if (index_of.size() < 2) return;
    for (auto& [reference, index] : index_of) {
        index = static_cast<std::uint32_t>(regions.names.size());
        regions.names.push_back("reference_" + std::to_string(reference));
    }
    for (const std::int64_t reference : references)
        regions.region_of_tetrahedron.push_back(index_of[reference]);
}

}  // namespace

RawMesh read_medit(std::string_view content) {
    TextReader reader(content, '#');
    RawMesh mesh;
    mesh.numbering = "numbered from 1";
    std::vector<std::int64_t> references;
    std::set<std::string_view> seen;
    for (std::string_view keyword = reader.next(); !keyword.empty() && keyword != "End";
         keyword = reader.next()) {
        if (!seen.insert(keyword).second) reader.fail("a second " + in_quotes(keyword));
        if (keyword == "MeshVersionFormatted") {
            const std::int64_t version = reader.integer("the version");
            if (version < 1 || version > 4)
                reader.fail("version " + std::to_string(version) + " is not known");
        } else if (keyword == "Dimension") {
            if (reader.integer("the dimension") != 3) reader.fail("the mesh is not three-dimensional");
        } else if (keyword == "Vertices") {
            read_vertices(reader, mesh);
        } else if (keyword == "Tetrahedra") {
            read_tetrahedra(reader, mesh, references);
        } else if (const auto skipped = skipped_sections().find(keyword);
                   skipped != skipped_sections().end()) {
            const std::size_t count = reader.count("the number of entries");
            for (std::size_t i = 0; i < count * static_cast<std::size_t>(skipped->second.words); ++i)
                reader.number("an entry");
            if (skipped->second.is_cell && count > 0) mesh.other_cells.emplace_back(keyword, count);
        } else {
            reader.fail(in_quotes(keyword) + " is not a section of a Medit mesh");
        }
    }
    if (!reader.at_end()) reader.fail("the file goes on after its End");
    make_regions(references, mesh.regions);
    return mesh;
}

}  // namespace knead::tools
