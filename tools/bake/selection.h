// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "knead/formats/tet_mesh.h"
#include "scene/scene.h"

namespace knead::tools {

/// Which nodes of `mesh` a selection of the scene means; all conditions given must hold. A side means the
/// nodes within kSideTolerance of the bounding box's longest edge from that side; a box and a ball include
/// their border.
/// @return one flag per node
[[nodiscard]] std::vector<bool> select_nodes(const TetMesh& mesh, const Selection& selection);

inline constexpr double kSideTolerance = 1e-6;  ///< meshers leave rounding of about 1e-9 of the size

}  // namespace knead::tools
