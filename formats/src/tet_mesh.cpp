// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/tet_mesh.h"

namespace knead {

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
        for (int axis = 0; axis < 3; ++axis) sum[axis] += 0.25 * mesh.nodes_m[node][axis];
    return sum;
}

}  // namespace knead
