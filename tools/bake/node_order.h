// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// Nested-dissection order (METIS_NodeND) of the free nodes: eliminating them in this order fills the factor
/// of the stiffness matrix little. Depends on the arguments only.
///
/// @param free one flag per node; nodes that are not free are not ordered
/// @return the free nodes, first to be eliminated first
[[nodiscard]] std::vector<std::uint32_t> nested_dissection_order(const std::vector<Tetrahedron>& tetrahedra,
                                                                 const std::vector<bool>& free);

}  // namespace knead::tools
