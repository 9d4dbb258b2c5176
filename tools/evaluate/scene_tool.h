// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "evaluate/loads.h"
#include "knead/formats/asset.h"
#include "knead/formats/material.h"
#include "reference/contact_problem.h"

namespace knead::tools {

/// How far a scene's own tool is pressed: share of the object's extent along the press.
inline constexpr double kScenePress = 0.1;

/// The press of a tool of the scene: straight along the -z axis of the tool from its rest pose.
struct ToolPress {
    ToolSet tool;       ///< its nodes are those of the mesh
    Point direction{};  ///< unit length
    double way_m = 0;
    [[nodiscard]] RigidPose pose_at_end() const;
};

/// @param asset baked from `mesh`; tells which of its nodes the tool has
/// @param object bounding box of the fine mesh
[[nodiscard]] ToolPress tool_press(const Asset& asset, std::size_t tool, const TetMesh& mesh,
                                   const Box& object);

/// The same as a prescribed motion: bonded tools only.
[[nodiscard]] AppliedLoad apply_press(const ToolPress& press, const std::vector<bool>& is_held);

/// The tool with the nodes and the motion of a load that has no ties, in an asset baked from `mesh`: for
/// asking the runtime for the same force. @pre no ties, no turn
void replace_tools(Asset& asset, const AppliedLoad& load, const TetMesh& mesh);

}  // namespace knead::tools
