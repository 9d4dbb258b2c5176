// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "knead/formats/tet_mesh.h"

namespace knead::test {

/// Cube of n x n x n sub-cubes of six tetrahedra each, corner at the origin.
[[nodiscard]] TetMesh cube_mesh(int n, double side_m);

/// Moves every node that is not on the surface of [0, side]^3 by up to `share` of a sub-cube along each axis.
[[nodiscard]] TetMesh jittered(TetMesh mesh, int n, double side_m, double share, std::uint64_t seed);

/// Rotated about the axis (1, 2, 3) by `angle_rad`, then shifted.
[[nodiscard]] TetMesh rigidly_moved(TetMesh mesh, double angle_rad, const Point& shift_m);

}  // namespace knead::test
