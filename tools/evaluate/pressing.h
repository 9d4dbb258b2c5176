// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "knead/formats/asset.h"
#include "knead/runtime/simulation.h"

namespace knead::tools {

/// The runtime with one tool of an asset, made for steps of `dt_s`.
/// @throws ToolError(no_valid_result) when the runtime refuses the asset
[[nodiscard]] Simulation simulation_of(const Asset& asset, std::size_t tool, double dt_s);

/// `pose` shifted by `way_m` along the unit vector `direction`.
[[nodiscard]] Pose moved(Pose pose, const Point& direction, double way_m);

}  // namespace knead::tools
