// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "core/step.h"
#include "unit/runtime/block_asset.h"

namespace knead::test {

/// The tool's pose when it has moved from its rest pose by `move_m`.
inline Pose moved(const Asset& asset, const Vec3& move_m) {
    Pose pose{asset.tools[0].rest_position_m, asset.tools[0].rest_orientation_wxyz};
    for (std::size_t axis = 0; axis < 3; ++axis)
        pose.position_m[axis] += move_m[axis];
    return pose;
}

/// Moves the tool to `move_m` in `ramp` steps of 20 ms and holds it for `hold`: to equilibrium.
inline StepResult settle(core::Stepper& stepper, const Asset& asset, const Vec3& move_m, int ramp = 50,
                         int hold = 250) {
    StepResult result;
    std::uint32_t status = 0;
    for (int i = 1; i <= ramp + hold; ++i) {
        const double share = std::min(1.0, static_cast<double>(i) / ramp);
        result = stepper.step(moved(asset, {share * move_m[0], share * move_m[1], share * move_m[2]}), 20e-3);
        status |= result.status;
    }
    result.status = status;
    return result;
}

/// Tight enough that a force is good to more digits than any check here asks.
inline SimulationConfig precise() {
    SimulationConfig config;
    config.force_tolerance = 1e-9;
    config.max_solver_iterations = 5000;
    return config;
}

}  // namespace knead::test
