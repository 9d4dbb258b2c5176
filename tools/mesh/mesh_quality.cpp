// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mesh_quality.h"

#include <algorithm>
#include <cmath>

#include "mesh/union_find.h"

namespace knead::tools {
namespace {

Point minus(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double length(const Point& a) {
    return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}
double triangle_area(const Point& a, const Point& b, const Point& c) {
    const Point u = minus(b, a);
    const Point v = minus(c, a);
    return 0.5 * length({u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]});
}

}  // namespace

double radius_ratio(const Point& a, const Point& b, const Point& c, const Point& d) {
    const double volume = std::abs(signed_volume_m3(a, b, c, d));
    const double area =
        triangle_area(a, b, c) + triangle_area(a, b, d) + triangle_area(a, c, d) + triangle_area(b, c, d);
    // Circumscribed radius from the products of opposite edges (Crelle's formula).
    const double p = length(minus(a, b)) * length(minus(c, d));
    const double q = length(minus(a, c)) * length(minus(b, d));
    const double r = length(minus(a, d)) * length(minus(b, c));
    const double product = std::max(0.0, (p + q + r) * (p + q - r) * (p - q + r) * (-p + q + r));
    if (volume <= 0 || area <= 0 || product <= 0) return 0;
    const double inscribed = 3 * volume / area;
    const double circumscribed = std::sqrt(product) / (24 * volume);
    return 3 * inscribed / circumscribed;
}

MeshQuality measure(const TetMesh& mesh) {
    MeshQuality quality;
    UnionFind joined(mesh.nodes_m.size());
    quality.min_radius_ratio = 1;
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        const Tetrahedron& nodes = mesh.tetrahedra[t];
        const double ratio = radius_ratio(mesh.nodes_m[nodes[0]], mesh.nodes_m[nodes[1]],
                                          mesh.nodes_m[nodes[2]], mesh.nodes_m[nodes[3]]);
        quality.volume_m3 += signed_volume_m3(mesh, t);
        quality.mean_radius_ratio += ratio;
        quality.min_radius_ratio = std::min(quality.min_radius_ratio, ratio);
        if (ratio < kSliverRadiusRatio) quality.slivers.push_back(t);
        for (int i = 1; i < 4; ++i)
            joined.join(nodes[0], nodes[i]);
    }
    quality.mean_radius_ratio /= static_cast<double>(mesh.tetrahedra.size());
    const std::vector<std::uint32_t> bodies = joined.labels();
    quality.bodies = 1 + *std::max_element(bodies.begin(), bodies.end());
    quality.low_m = quality.high_m = mesh.nodes_m[0];
    for (const Point& node : mesh.nodes_m)
        for (int axis = 0; axis < 3; ++axis) {
            quality.low_m[axis] = std::min(quality.low_m[axis], node[axis]);
            quality.high_m[axis] = std::max(quality.high_m[axis], node[axis]);
        }
    return quality;
}

}  // namespace knead::tools
