// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "knead/formats/tet_mesh.h"

namespace knead::test {

using Corners = std::array<Point, 4>;

/// Volume common to two tetrahedra, in exact rational arithmetic, rounded once at the end.
///
/// Shares no code and no idea with the tool, which cuts one tetrahedron by the planes of the other: here
/// every point in which three of the eight face planes meet is tested against all eight half spaces, and the
/// volume is that of CGAL's convex hull of the points that pass.
double exact_shared_volume(const Corners& a, const Corners& b);

/// Volume of one tetrahedron, in exact rational arithmetic, rounded once at the end.
double exact_volume(const Corners& corners);

}  // namespace knead::test
