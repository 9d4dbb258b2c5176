// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "knead/formats/overlap.h"
#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// A mesh that an object is coarsened to, and how it lies in the fine mesh.
struct LevelMesh {
    TetMesh mesh;
    bool is_fine = false;   ///< it is the fine mesh itself; the overlap is then empty
    OverlapMatrix overlap;  ///< with the fine mesh
};

/// @param coarse_mesh the fine mesh itself when `is_fine`
[[nodiscard]] LevelMesh make_level_mesh(const TetMesh& fine, TetMesh coarse_mesh, bool is_fine);

/// A point of one mesh as a weighted mean of the nodes of another: x = sum_k weights[k] * x[nodes[k]].
struct Interpolated {
    std::array<std::uint32_t, 4> nodes{};
    std::array<double, 4> weights{};
};

/// Where the nodes of one mesh lie in another; a node outside of it is continued from the nearest
/// tetrahedron.
[[nodiscard]] std::vector<Interpolated> interpolate(const std::vector<Point>& points_m, const TetMesh& mesh);
/// Values at such points.
[[nodiscard]] std::vector<Point> values_at(const std::vector<Interpolated>& points,
                                           const std::vector<Point>& node_values);

/// Nodes of the outer triangles, increasing.
[[nodiscard]] std::vector<std::uint32_t> surface_nodes(const TetMesh& mesh);

}  // namespace knead::tools
