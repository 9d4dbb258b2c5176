// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/tet_mesh.h"

#include "failure.h"
#include "mesh_checks.h"
#include "offenders.h"

namespace knead {
namespace {

void check_regions(const Regions& regions, std::size_t tetrahedron_count) {
    const std::string where = "/knead/mesh/regions";
    check_names(regions.names, "a region's name", where + "/names");
    const auto& index = regions.region_of_tetrahedron;
    if (index.empty() && regions.names.empty()) return;
    if (index.size() != tetrahedron_count)
        fail(ErrorCode::invalid_data,
             std::to_string(index.size()) + " entries for " + std::to_string(tetrahedron_count) +
                 " tetrahedra",
             where + "/region_of_tetrahedron");
    Offenders bad;
    for (std::size_t i = 0; i < index.size(); ++i)
        if (index[i] >= regions.names.size()) bad.add(i);
    if (bad.any())
        fail(ErrorCode::invalid_data, bad.text(index.size(), "entries name no region", "elements"),
             where + "/region_of_tetrahedron");
}

void check_cell_arrays(const std::vector<CellArray>& arrays, std::size_t tetrahedron_count) {
    const std::string where = "/knead/mesh/cell_arrays";
    std::vector<std::string> names;
    for (const CellArray& array : arrays) {
        names.push_back(array.name);
        if (array.values.size() != tetrahedron_count)
            fail(ErrorCode::invalid_data,
                 "array \"" + array.name + "\" has " + std::to_string(array.values.size()) + " values for " +
                     std::to_string(tetrahedron_count) + " tetrahedra",
                 where);
    }
    check_names(names, "an array's name", where);
}

}  // namespace

double signed_volume_m3(const Point& a, const Point& b, const Point& c, const Point& d) {
    const Point u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const Point v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const Point w{d[0] - a[0], d[1] - a[1], d[2] - a[2]};
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
            u[2] * (v[0] * w[1] - v[1] * w[0])) /
           6.0;
}

double signed_volume_m3(const TetMesh& mesh, std::size_t tetrahedron) {
    const Tetrahedron& t = mesh.tetrahedra[tetrahedron];
    return signed_volume_m3(mesh.nodes_m[t[0]], mesh.nodes_m[t[1]], mesh.nodes_m[t[2]], mesh.nodes_m[t[3]]);
}

Point barycentre_m(const TetMesh& mesh, std::size_t tetrahedron) {
    Point sum{};
    for (const std::uint32_t node : mesh.tetrahedra[tetrahedron])
        for (int axis = 0; axis < 3; ++axis)
            sum[axis] += 0.25 * mesh.nodes_m[node][axis];
    return sum;
}

Status validate(const TetMesh& mesh) {
    return guarded("/knead/mesh", [&] {
        check_mesh(mesh.nodes_m, mesh.tetrahedra, "/knead/mesh");
        check_regions(mesh.regions, mesh.tetrahedra.size());
        check_cell_arrays(mesh.cell_arrays, mesh.tetrahedra.size());
        return Unit{};
    });
}

}  // namespace knead
