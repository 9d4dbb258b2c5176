// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// The paper's cubes: the box [0, size] cut into nx * ny * nz equal sub-cubes, each cut into the six Kuhn
/// tetrahedra around its main diagonal (0,0,0)-(1,1,1); z is up.
///
/// Node (i, j, k) has index i + (nx + 1) * (j + (ny + 1) * k). Sub-cubes follow in the same order, their six
/// tetrahedra one after the other, in the same order in each. Neighbouring sub-cubes share their face
/// diagonals. Throws ToolError: bad_usage for a count of zero, a size that is not finite and > 0, or more
/// nodes than a 32-bit index can name. Source: paper section 4.1 (6,000 / 3,072 / 1,296 tetrahedra for n = 10
/// / 8 / 6).
[[nodiscard]] TetMesh make_cubes(const std::array<std::uint32_t, 3>& divisions,
                                 const std::array<double, 3>& size_m);

}  // namespace knead::tools
