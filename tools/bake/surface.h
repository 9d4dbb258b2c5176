// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

using Triangle = std::array<std::uint32_t, 3>;

/// The faces that belong to one tetrahedron only, corners counter-clockwise seen from outside, in the order
/// of their tetrahedra.
[[nodiscard]] std::vector<Triangle> boundary_triangles(const std::vector<Tetrahedron>& tetrahedra);

}  // namespace knead::tools
