// SPDX-License-Identifier: Apache-2.0
#include "load.h"
#include "read_kind.h"
#include "schema.h"

namespace knead {
namespace {

const std::string kMesh = "/knead/mesh";
const std::string kRegions = kMesh + "/regions";
const std::string kCellArrays = kMesh + "/cell_arrays";

}  // namespace

std::uint64_t check_mesh_shape(Schema& schema, const std::string& group) {
    schema.group(group);
    const std::string at_nodes = group + "/nodes_m", at_tetrahedra = group + "/tetrahedra";
    schema.limit(schema.dataset(at_nodes, ScalarType::f64, {kAnyExtent, 3}, "m"), schema.limits().max_nodes,
                 "nodes", at_nodes);
    const std::uint64_t indices = schema.dataset(at_tetrahedra, ScalarType::i32, {kAnyExtent}, "1");
    schema.limit(indices / 4, schema.limits().max_tetrahedra, "tetrahedra", at_tetrahedra);
    if (indices % 4 != 0)
        schema.refuse(ErrorCode::wrong_extent,
                      std::to_string(indices) + " indices are not four for each tetrahedron", at_tetrahedra);
    return indices / 4;
}

std::uint64_t check_tet_mesh_shape(Schema& schema) {
    const std::uint64_t tetrahedra = check_mesh_shape(schema, kMesh);
    if (schema.has(kRegions)) {
        schema.group(kRegions);
        schema.text_dataset(kRegions + "/names");
        schema.dataset(kRegions + "/region_of_tetrahedron", ScalarType::u32, {tetrahedra}, "1");
    }
    if (schema.has(kCellArrays)) {
        schema.group(kCellArrays);
        for (const std::string& child : schema.children(kCellArrays)) {
            schema.dataset(kCellArrays + "/" + child, ScalarType::f64, {tetrahedra}, "as named");
            schema.text_attribute(kCellArrays + "/" + child, "name");
        }
        schema.limit(schema.children(kCellArrays).size(), schema.limits().max_names, "arrays", kCellArrays);
    }
    return tetrahedra;
}

TetMesh take_tet_mesh(Schema& schema) {
    TetMesh mesh;
    mesh.nodes_m = schema.take<Point>(kMesh + "/nodes_m");
    // Stored as int32 for VTK; a negative index becomes one far beyond the nodes, which validate() refuses.
    mesh.tetrahedra = schema.take<Tetrahedron>(kMesh + "/tetrahedra");
    if (schema.has(kRegions)) {
        mesh.regions.names = schema.take_texts(kRegions + "/names");
        mesh.regions.region_of_tetrahedron = schema.take<std::uint32_t>(kRegions + "/region_of_tetrahedron");
    }
    if (schema.has(kCellArrays))
        for (const std::string& child : schema.children(kCellArrays)) {
            const std::string path = kCellArrays + "/" + child;
            mesh.cell_arrays.push_back({schema.text_of(path, "name"), schema.take<double>(path)});
        }
    return mesh;
}

template <>
Result<Stored<TetMesh>> read_stored<TetMesh>(const std::filesystem::path& file, const ReadLimits& limits) {
    return read_kind<TetMesh>(file, limits, {FileKind::tet_mesh, FileKind::material, FileKind::clustering},
                              [](Schema& schema) {
                                  TetMesh mesh = take_tet_mesh(schema);
                                  value_or_fail(validate(mesh));
                                  return mesh;
                              });
}

Result<TetMesh> read_tet_mesh(const std::filesystem::path& file, const ReadLimits& limits) {
    return value_of(read_stored<TetMesh>(file, limits));
}

}  // namespace knead
