// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/mesh_quality.h"

#include <algorithm>
#include <numeric>

#include "quality/union_find.h"

namespace knead::tools {
namespace {

template <std::size_t kBins>
void count_in(std::array<std::uint64_t, kBins>& histogram, double value, double bin_width) {
    ++histogram[std::min(static_cast<std::size_t>(value / bin_width), kBins - 1)];
}

void add(const TetShape& shape, std::uint32_t t, MeshQuality& quality) {
    quality.mean_radius_ratio += shape.radius_ratio;
    quality.mean_mean_ratio += shape.mean_ratio;
    quality.mean_edge_m += shape.mean_edge_m;
    quality.min_radius_ratio = std::min(quality.min_radius_ratio, shape.radius_ratio);
    quality.min_mean_ratio = std::min(quality.min_mean_ratio, shape.mean_ratio);
    quality.min_dihedral_deg = std::min(quality.min_dihedral_deg, shape.min_dihedral_deg);
    quality.max_dihedral_deg = std::max(quality.max_dihedral_deg, shape.max_dihedral_deg);
    quality.shortest_edge_m =
        t == 0 ? shape.shortest_edge_m : std::min(quality.shortest_edge_m, shape.shortest_edge_m);
    quality.longest_edge_m = std::max(quality.longest_edge_m, shape.longest_edge_m);
    count_in(quality.radius_ratio_histogram, shape.radius_ratio, 0.1);
    count_in(quality.min_dihedral_histogram, shape.min_dihedral_deg, 10);
    if (shape.radius_ratio < kSliverRadiusRatio) quality.slivers.push_back(t);
    if (shape.thinness < kInvertedByStrain) quality.near_inverted.push_back(t);
}

std::vector<WorstTetrahedron> worst_of(const TetMesh& mesh, const std::vector<TetShape>& shapes) {
    std::vector<std::uint32_t> order(shapes.size());
    std::iota(order.begin(), order.end(), 0U);
    const std::size_t named = std::min(kWorstNamed, order.size());
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(named), order.end(),
                      [&](std::uint32_t a, std::uint32_t b) {
                          return shapes[a].radius_ratio != shapes[b].radius_ratio
                                     ? shapes[a].radius_ratio < shapes[b].radius_ratio
                                     : a < b;
                      });
    std::vector<WorstTetrahedron> worst;
    for (std::size_t k = 0; k < named; ++k)
        worst.push_back({order[k], barycentre_m(mesh, order[k]), shapes[order[k]]});
    return worst;
}

}  // namespace

double MeshQuality::extent_m() const {
    return std::max({high_m[0] - low_m[0], high_m[1] - low_m[1], high_m[2] - low_m[2]});
}

MeshQuality measure(const TetMesh& mesh) {
    MeshQuality quality;
    quality.min_radius_ratio = quality.min_mean_ratio = 1;
    quality.min_dihedral_deg = 180;
    UnionFind joined(mesh.nodes_m.size());
    std::vector<TetShape> shapes;
    shapes.reserve(mesh.tetrahedra.size());
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        const Tetrahedron& nodes = mesh.tetrahedra[t];
        shapes.push_back(shape_of(mesh.nodes_m[nodes[0]], mesh.nodes_m[nodes[1]], mesh.nodes_m[nodes[2]],
                                  mesh.nodes_m[nodes[3]]));
        quality.volume_m3 += signed_volume_m3(mesh, t);
        add(shapes.back(), t, quality);
        for (std::size_t i = 1; i < 4; ++i)
            joined.join(nodes[0], nodes[i]);
    }
    const auto count = static_cast<double>(mesh.tetrahedra.size());
    quality.mean_radius_ratio /= count;
    quality.mean_mean_ratio /= count;
    quality.mean_edge_m /= count;
    quality.worst = worst_of(mesh, shapes);
    const std::vector<std::uint32_t> bodies = joined.labels();
    quality.bodies = 1 + *std::max_element(bodies.begin(), bodies.end());
    quality.low_m = quality.high_m = mesh.nodes_m[0];
    for (const Point& node : mesh.nodes_m)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            quality.low_m[axis] = std::min(quality.low_m[axis], node[axis]);
            quality.high_m[axis] = std::max(quality.high_m[axis], node[axis]);
        }
    return quality;
}

}  // namespace knead::tools
