// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "knead/formats/session_log.h"

namespace knead {

inline const std::string kSession = "/knead/session";
inline const std::string kSettings = kSession + "/settings";
inline const std::string kTicks = kSession + "/ticks";
inline const std::string kSteps = kSession + "/steps";

/// The arrays of a log with their names and units on disk, for check, reader and writer alike:
/// visit(name, array, units).
template <class Ticks, class Visit>
auto for_each_array(Ticks& ticks, Visit&& visit) -> decltype((void)ticks.device_time_s) {
    visit("number", ticks.number, "1");
    visit("dt_s", ticks.dt_s, "s");
    visit("device_time_s", ticks.device_time_s, "s");
    visit("device_position_m", ticks.device_position_m, "m");
    visit("device_orientation_wxyz", ticks.device_orientation_wxyz, "1");
    visit("device_velocity_m_per_s", ticks.device_velocity_m_per_s, "m/s");
    visit("device_buttons", ticks.device_buttons, "1");
    visit("used_step", ticks.used_step, "1");
    visit("tool_position_m", ticks.tool_position_m, "m");
    visit("tool_orientation_wxyz", ticks.tool_orientation_wxyz, "1");
    visit("scene_force_n", ticks.scene_force_n, "N");
    visit("scene_torque_nm", ticks.scene_torque_nm, "N m");
    visit("force_n", ticks.force_n, "N");
    visit("torque_nm", ticks.torque_nm, "N m");
    visit("status", ticks.status, "1");
    visit("step_status", ticks.step_status, "1");
    visit("touched_nodes", ticks.touched_nodes, "1");
}

template <class Steps, class Visit>
auto for_each_array(Steps& steps, Visit&& visit) -> decltype((void)steps.hand_tick) {
    visit("number", steps.number, "1");
    visit("hand_tick", steps.hand_tick, "1");
    visit("dt_s", steps.dt_s, "s");
    visit("force_n", steps.force_n, "N");
    visit("torque_nm", steps.torque_nm, "N m");
    visit("status", steps.status, "1");
    visit("touched_nodes", steps.touched_nodes, "1");
    visit("solver_iterations", steps.solver_iterations, "1");
}

}  // namespace knead
