// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "knead/formats/session_log.h"

namespace knead::test {

/// Five ticks and two steps: step 1 used tick 1 and is used from tick 3 on, step 2 used tick 3 and is used by
/// tick 5.
inline SessionLog sample_session() {
    SessionLog log;
    log.asset_content_hash = std::string(64, 'b');
    log.settings = {{"haptic.rate_hz", 1000}, {"simulation.expected_dt_s", 1e-3}};
    log.lost_ticks = 3;
    log.lost_steps = 1;
    SessionLog::Ticks& t = log.ticks;
    for (std::uint64_t i = 1; i <= 5; ++i) {
        const auto x = static_cast<double>(i);
        t.number.push_back(i);
        t.dt_s.push_back(1e-3);
        t.device_time_s.push_back(1e-3 * x);
        t.device_position_m.push_back({0.1 * x, -x / 3, 1e-9});
        t.device_orientation_wxyz.push_back({0.6, 0, 0.8, 0});
        t.device_velocity_m_per_s.push_back({0, -x / 7, 0});
        t.device_buttons.push_back(static_cast<std::uint32_t>(i % 2));
        t.used_step.push_back(i < 3 ? 0 : i < 5 ? 1 : 2);
        t.tool_position_m.push_back({x / 9, 0, 1});
        t.tool_orientation_wxyz.push_back({0, 1, 0, 0});
        t.scene_force_n.push_back({0, 0, x});
        t.scene_torque_nm.push_back({x / 11, 0, 0});
        t.force_n.push_back({0, 0, 0.5 * x});
        t.torque_nm.push_back({0, x / 13, 0});
        t.status.push_back(static_cast<std::uint32_t>(1U << i));
        t.step_status.push_back(0);
        t.touched_nodes.push_back(static_cast<std::uint32_t>(7 * i));
    }
    log.steps.number = {1, 2};
    log.steps.hand_tick = {1, 3};
    log.steps.dt_s = {1.0 / 120, 1.0 / 120};
    log.steps.force_n = {{1, 2, 3}, {4, 5, 6}};
    log.steps.torque_nm = {{0, 0, 0.1}, {0, 0, 0.2}};
    log.steps.status = {0, 1};
    log.steps.touched_nodes = {3, 4};
    log.steps.solver_iterations = {12, 0};
    return log;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// Bit by bit: a NaN is the same NaN, and zero is not minus zero.
inline bool same(const SessionLog& a, const SessionLog& b) {
    if (a.settings.size() != b.settings.size()) return false;
    for (std::size_t i = 0; i < a.settings.size(); ++i)
        if (a.settings[i].name != b.settings[i].name || a.settings[i].value != b.settings[i].value)
            return false;
    const SessionLog::Ticks &t = a.ticks, &u = b.ticks;
    const SessionLog::Steps &s = a.steps, &r = b.steps;
    return a.asset_content_hash == b.asset_content_hash && a.lost_ticks == b.lost_ticks &&
           a.lost_steps == b.lost_steps && same_bytes(t.number, u.number) && same_bytes(t.dt_s, u.dt_s) &&
           same_bytes(t.device_time_s, u.device_time_s) &&
           same_bytes(t.device_position_m, u.device_position_m) &&
           same_bytes(t.device_orientation_wxyz, u.device_orientation_wxyz) &&
           same_bytes(t.device_velocity_m_per_s, u.device_velocity_m_per_s) &&
           same_bytes(t.device_buttons, u.device_buttons) && same_bytes(t.used_step, u.used_step) &&
           same_bytes(t.tool_position_m, u.tool_position_m) &&
           same_bytes(t.tool_orientation_wxyz, u.tool_orientation_wxyz) &&
           same_bytes(t.scene_force_n, u.scene_force_n) && same_bytes(t.scene_torque_nm, u.scene_torque_nm) &&
           same_bytes(t.force_n, u.force_n) && same_bytes(t.torque_nm, u.torque_nm) &&
           same_bytes(t.status, u.status) && same_bytes(t.step_status, u.step_status) &&
           same_bytes(t.touched_nodes, u.touched_nodes) && same_bytes(s.number, r.number) &&
           same_bytes(s.hand_tick, r.hand_tick) && same_bytes(s.dt_s, r.dt_s) &&
           same_bytes(s.force_n, r.force_n) && same_bytes(s.torque_nm, r.torque_nm) &&
           same_bytes(s.status, r.status) && same_bytes(s.touched_nodes, r.touched_nodes) &&
           same_bytes(s.solver_iterations, r.solver_iterations);
}

}  // namespace knead::test
