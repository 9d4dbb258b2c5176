// SPDX-License-Identifier: Apache-2.0
#include "encode.h"

#include <set>

#include "../mesh_checks.h"

namespace knead {
namespace {

/// What VTK shows an array as: printable, without '/', and not the name of another one.
std::string cell_data_name(const std::string& name, std::set<std::string>& taken) {
    std::string safe;
    for (const char c : name)
        safe += (c > ' ' && c < '\x7f' && c != '/') ? c : '_';
    if (safe == "." || safe == "..") safe = "_";
    safe.resize(std::min<std::size_t>(safe.size(), 200));
    std::string unique = safe;
    for (int i = 2; !taken.insert(unique).second; ++i)
        unique = safe + "_" + std::to_string(i);
    return unique;
}

void encode_regions(FilePlan& plan, const Regions& regions, const std::string& group) {
    if (regions.region_of_tetrahedron.empty()) return;
    Payload& payload = plan.payload;
    payload.add_group(group);
    payload.add_dataset(group + "/names", text_array(regions.names), "none");
    payload.add_dataset(group + "/region_of_tetrahedron", view_1d(regions.region_of_tetrahedron), "1");
    plan.vtk->cell_data.push_back({"region", group + "/region_of_tetrahedron"});
}

void encode_cell_arrays(FilePlan& plan, const std::vector<CellArray>& arrays, const std::string& group) {
    if (arrays.empty()) return;
    plan.payload.add_group(group);
    std::set<std::string> taken{"region", "youngs_modulus_pa", "poissons_ratio", "density_kg_per_m3",
                                "bin",    "material_bin",      "cluster"};
    for (std::size_t i = 0; i < arrays.size(); ++i) {
        const std::string path = group + "/" + list_name(i);
        Node& node = plan.payload.add_dataset(path, view_1d(arrays[i].values), "as named");
        node.attributes["name"] = text_value(arrays[i].name);
        plan.vtk->cell_data.push_back({cell_data_name(arrays[i].name, taken), path});
    }
}

}  // namespace

std::string list_name(std::size_t index) {
    const std::string digits = std::to_string(index);
    return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

void encode_nodes_and_tetrahedra(Payload& payload, const std::string& group,
                                 const std::vector<Point>& nodes_m,
                                 const std::vector<Tetrahedron>& tetrahedra) {
    payload.add_group(group);
    payload.add_dataset(group + "/nodes_m", view_2d(nodes_m), "m");
    // validate() has made sure that every index fits in VTK's int32.
    Value indices = view_2d(tetrahedra);
    indices.type = ScalarType::i32;
    indices.extents = {4 * tetrahedra.size()};
    payload.add_dataset(group + "/tetrahedra", std::move(indices), "1");
}

void encode_mesh(FilePlan& plan, const TetMesh& mesh) {
    const std::string group = "/knead/mesh";
    encode_nodes_and_tetrahedra(plan.payload, group, mesh.nodes_m, mesh.tetrahedra);
    plan.vtk = VtkPart{group + "/nodes_m", group + "/tetrahedra", {}};
    encode_regions(plan, mesh.regions, group + "/regions");
    encode_cell_arrays(plan, mesh.cell_arrays, group + "/cell_arrays");
}

void encode_material(FilePlan& plan, const Material& material, const std::string& bin_name) {
    const std::string group = "/knead/material";
    plan.payload.add_group(group);
    const auto add = [&](const char* name, Value value, const char* units, const std::string& vtk_name) {
        plan.payload.add_dataset(group + "/" + name, std::move(value), units);
        plan.vtk->cell_data.push_back({vtk_name, group + "/" + name});
    };
    add("youngs_modulus_pa", view_1d(material.youngs_modulus_pa), "Pa", "youngs_modulus_pa");
    add("poissons_ratio", view_1d(material.poissons_ratio), "1", "poissons_ratio");
    add("density_kg_per_m3", view_1d(material.density_kg_per_m3), "kg/m^3", "density_kg_per_m3");
    if (!material.bin_of_tetrahedron.empty())
        add("bin_of_tetrahedron", view_1d(material.bin_of_tetrahedron), "1", bin_name);
}

void encode_provenance(Payload& payload, const Provenance& provenance) {
    const std::string group = "/provenance";
    check_text(provenance.tool, "the tool's name", group);
    check_text(provenance.tool_version, "the tool's version", group);
    Node& node = payload.add_group(group);
    node.attributes["tool"] = text_value(provenance.tool);
    node.attributes["tool_version"] = text_value(provenance.tool_version);
    node.attributes["seed"] = scalar(provenance.seed);
    for (const std::string& argument : provenance.arguments)
        check_text(argument, "an argument", group);
    if (!provenance.arguments.empty())
        payload.add_dataset(group + "/arguments", text_array(provenance.arguments), "none");
    if (provenance.inputs.empty()) return;
    std::vector<std::string> roles, hashes;
    for (const auto& [role, hash] : provenance.inputs) {
        check_text(role, "an input's role", group + "/inputs");
        check_text(hash, "an input's content hash", group + "/inputs");
        roles.push_back(role);
        hashes.push_back(hash);
    }
    payload.add_group(group + "/inputs");
    payload.add_dataset(group + "/inputs/roles", text_array(roles), "none");
    payload.add_dataset(group + "/inputs/content_hashes", text_array(hashes), "none");
}

}  // namespace knead
