// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

inline constexpr std::uint32_t kNoNeighbour = UINT32_MAX;

/// For every tetrahedron, the tetrahedron behind each of its faces; face f is opposite its node f.
/// kNoNeighbour on the surface.
using FaceNeighbours = std::vector<std::array<std::uint32_t, 4>>;

/// Pairs up equal faces. Should more than two tetrahedra share a face, they are paired in index order.
[[nodiscard]] FaceNeighbours face_neighbours(const std::vector<Tetrahedron>& tetrahedra);

}  // namespace knead::tools
