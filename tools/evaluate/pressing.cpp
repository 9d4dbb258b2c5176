// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/pressing.h"

#include <utility>

#include "common/error.h"

namespace knead::tools {

Simulation simulation_of(const Asset& asset, std::size_t tool, double dt_s) {
    SimulationConfig config;
    config.tools = {tool};
    config.expected_dt_s = dt_s;
    Result<Simulation> created = Simulation::create(asset, config);
    if (!created.ok()) fail_result("the runtime refuses the asset: " + created.error().text());
    return std::move(created).value();
}

Pose moved(Pose pose, const Point& direction, double way_m) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        pose.position_m[axis] += way_m * direction[axis];
    return pose;
}

}  // namespace knead::tools
