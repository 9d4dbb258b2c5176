// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// Tetrahedra below this radius ratio are named as slivers: they make a simulation slow or unstable.
inline constexpr double kSliverRadiusRatio = 0.05;

/// Shape of the tetrahedra as their radius ratio: 3 * inscribed / circumscribed radius, 1 for the regular
/// tetrahedron, 0 for a flat one.
struct MeshQuality {
    double volume_m3 = 0;
    double min_radius_ratio = 0;
    double mean_radius_ratio = 0;
    std::vector<std::uint32_t> slivers;  ///< positions of those below kSliverRadiusRatio
    std::uint32_t bodies = 0;            ///< parts that share no node
    Point low_m{};                       ///< bounding box
    Point high_m{};
};

[[nodiscard]] double radius_ratio(const Point& a, const Point& b, const Point& c, const Point& d);

/// Precondition: the mesh is valid.
[[nodiscard]] MeshQuality measure(const TetMesh& mesh);

}  // namespace knead::tools
