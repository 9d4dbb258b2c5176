// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/level_mesh.h"

#include <utility>

#include "bake/surface.h"
#include "bake/tetrahedron_tree.h"
#include "overlap/overlap.h"

namespace knead::tools {

LevelMesh make_level_mesh(const TetMesh& fine, TetMesh coarse_mesh, bool is_fine) {
    LevelMesh level{std::move(coarse_mesh), is_fine, {}};
    if (!is_fine) level.overlap = overlap_volumes(fine, level.mesh, {});
    return level;
}

std::vector<Interpolated> interpolate(const std::vector<Point>& points_m, const TetMesh& mesh) {
    const NearestTetrahedra finder(mesh.nodes_m, mesh.tetrahedra);
    std::vector<Interpolated> result;
    result.reserve(points_m.size());
    for (const Point& point : points_m) {
        const NearTetrahedron near = finder.nearest(point, 0).front();
        result.push_back({mesh.tetrahedra[near.tetrahedron], near.weights});
    }
    return result;
}

std::vector<Point> values_at(const std::vector<Interpolated>& points, const std::vector<Point>& node_values) {
    std::vector<Point> values;
    values.reserve(points.size());
    for (const Interpolated& point : points) {
        Point value{};
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                value[axis] += point.weights[k] * node_values[point.nodes[k]][axis];
        values.push_back(value);
    }
    return values;
}

std::vector<std::uint32_t> surface_nodes(const TetMesh& mesh) {
    std::vector<bool> is_outer(mesh.nodes_m.size(), false);
    for (const Triangle& triangle : boundary_triangles(mesh.tetrahedra))
        for (const std::uint32_t node : triangle)
            is_outer[node] = true;
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t n = 0; n < is_outer.size(); ++n)
        if (is_outer[n]) nodes.push_back(n);
    return nodes;
}

}  // namespace knead::tools
