// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <new>
#include <stdexcept>
#include <utility>

#include "haptics/session_settings.h"
#include "knead/haptics/session.h"

namespace knead {
namespace {

template <class Apply>
void for_each_array(SessionLog::Ticks& t, Apply apply) {
    auto& [number, dt, time, position, orientation, velocity, buttons, used_step, tool, tool_turn,
           scene_force, scene_torque, force, torque, status, step_status, touched] = t;
    apply(number), apply(dt), apply(time), apply(position), apply(orientation), apply(velocity);
    apply(buttons), apply(used_step), apply(tool), apply(tool_turn), apply(scene_force), apply(scene_torque);
    apply(force), apply(torque), apply(status), apply(step_status), apply(touched);
}

template <class Apply>
void for_each_array(SessionLog::Steps& s, Apply apply) {
    auto& [number, hand_tick, dt, force, torque, status, touched, iterations] = s;
    apply(number), apply(hand_tick), apply(dt), apply(force), apply(torque), apply(status);
    apply(touched), apply(iterations);
}

template <class Part>
void resize(Part& part, std::size_t rows) {
    for_each_array(part, [rows](auto& array) { array.resize(rows); });
}

bool is_content_hash(const std::string& text) {
    return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// How many of the first rows can be replayed: each tick's step and each step's tick is among them.
std::pair<std::size_t, std::size_t> complete_rows(const SessionLog& log, std::size_t ticks,
                                                  std::size_t steps) {
    const auto& used = log.ticks.used_step;
    const auto& number = log.ticks.number;
    const std::uint64_t last_step = steps == 0 ? 0 : log.steps.number[steps - 1];
    std::size_t kept = 0;
    while (kept < ticks && used[kept] <= last_step)
        ++kept;
    const std::uint64_t last_tick = kept == 0 ? 0 : number[kept - 1];
    std::size_t kept_steps = 0;
    while (kept_steps < steps && log.steps.hand_tick[kept_steps] <= last_tick)
        ++kept_steps;
    return {kept, kept_steps};
}

}  // namespace

Result<SessionRecorder> SessionRecorder::create(const HapticConfig& haptic,
                                                const SimulationConfig& simulation,
                                                std::string asset_content_hash,
                                                const SessionCapacity& capacity) {
    if (!is_content_hash(asset_content_hash))
        return Error{ErrorCode::invalid_argument, "\"" + asset_content_hash + "\" is not a content hash",
                     "SessionRecorder"};
    if (simulation.tools.size() != 1)
        return Error{ErrorCode::invalid_argument, "a session has one tool", "SessionRecorder"};
    try {
        SessionRecorder recorder;
        recorder.log_.asset_content_hash = std::move(asset_content_hash);
        recorder.log_.settings = settings_of(haptic, simulation);
        resize(recorder.log_.ticks, capacity.ticks);
        resize(recorder.log_.steps, capacity.steps);
        return recorder;
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, "not enough memory", "SessionRecorder"};
    } catch (const std::length_error&) {
        return Error{ErrorCode::out_of_memory, "not enough memory", "SessionRecorder"};
    }
}

void SessionRecorder::record(const HapticTick& tick) noexcept {
    SessionLog::Ticks& t = log_.ticks;
    const std::size_t i = tick_count_;
    if (i == t.number.size()) {
        ++log_.lost_ticks;
        return;
    }
    t.number[i] = tick.number;
    t.dt_s[i] = tick.dt_s;
    t.device_time_s[i] = tick.device.time_s;
    t.device_position_m[i] = tick.device.pose.position_m;
    t.device_orientation_wxyz[i] = tick.device.pose.orientation_wxyz;
    t.device_velocity_m_per_s[i] = tick.device.velocity_m_per_s;
    t.device_buttons[i] = tick.device.buttons;
    t.used_step[i] = tick.model;
    t.tool_position_m[i] = tick.tool.position_m;
    t.tool_orientation_wxyz[i] = tick.tool.orientation_wxyz;
    t.scene_force_n[i] = tick.scene_force_n;
    t.scene_torque_nm[i] = tick.scene_torque_nm;
    t.force_n[i] = tick.device_force_n;
    t.torque_nm[i] = tick.device_torque_nm;
    t.status[i] = tick.status;
    t.step_status[i] = tick.step.status;
    t.touched_nodes[i] = tick.step.touched_nodes;
    tick_count_ = i + 1;
}

void SessionRecorder::record(const SimulationResult& result) noexcept {
    SessionLog::Steps& s = log_.steps;
    const std::size_t i = step_count_;
    if (i == s.number.size()) {
        ++log_.lost_steps;
        return;
    }
    s.number[i] = result.number;
    s.hand_tick[i] = result.hand_tick;
    s.dt_s[i] = result.dt_s;
    s.force_n[i] = result.step.force_n;
    s.torque_nm[i] = result.step.torque_nm;
    s.status[i] = result.step.status;
    s.touched_nodes[i] = result.step.touched_nodes;
    s.solver_iterations[i] = result.step.solver_iterations;
    step_count_ = i + 1;
}

SessionLog SessionRecorder::log() const {
    const auto [ticks, steps] = complete_rows(log_, tick_count_, step_count_);
    SessionLog log = log_;
    resize(log.ticks, ticks);
    resize(log.steps, steps);
    log.lost_ticks += tick_count_ - ticks;
    log.lost_steps += step_count_ - steps;
    return log;
}

}  // namespace knead
