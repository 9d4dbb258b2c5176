// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "knead/formats/asset.h"

namespace knead::tools {

/// Where a press with a tool goes, unit length: a plate and a ball along their own -z; a capsule down, along
/// its axis if that is steeper than 45 degrees and square to it if not.
[[nodiscard]] Point press_direction(const ToolSet& tool);

/// Where a point is for a tool that goes straight along its press_direction() from its rest pose.
struct ToolGap {
    double beside_m = 0;    ///< how far the tool passes beside it; 0: it is met
    double ahead_m = 0;     ///< way until it is met; negative: it is passed. Meaningful where beside_m is 0
    double overlap_m = 0;   ///< how deep it is inside the tool at rest; of a plate: behind its face
    double distance_m = 0;  ///< from the tool's surface at rest (of a plate: its rectangle); 0 inside
};
[[nodiscard]] ToolGap gap_of(const ToolSet& tool, const Point& point_m);

}  // namespace knead::tools
