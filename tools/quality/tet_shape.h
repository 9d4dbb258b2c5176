// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// How well a tetrahedron is shaped. All but the lengths do not change with size, place or turn.
struct TetShape {
    /// 3 x inscribed / circumscribed radius: 1 for the regular tetrahedron, 0 for a flat one.
    double radius_ratio = 0;
    /// 12 (3 V)^(2/3) / sum of the squared edges: likewise [LJ94].
    double mean_ratio = 0;
    double min_dihedral_deg = 0;  ///< the sharpest of the six angles between two faces; 70.53 if regular
    double max_dihedral_deg = 0;
    /// Smallest height over longest edge: the strain at which a press along that height turns it inside out.
    double thinness = 0;
    double smallest_height_m = 0;
    double shortest_edge_m = 0;
    double longest_edge_m = 0;
    double mean_edge_m = 0;  ///< of the six
};

/// The shape of the tetrahedron a, b, c, d, whatever its orientation. A flat one has both ratios 0.
/// Source: [LJ94] A. Liu, B. Joe: Relationship between tetrahedron shape measures. BIT 34, 1994.
[[nodiscard]] TetShape shape_of(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace knead::tools
