// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/touch_meter.h"

#include <algorithm>
#include <cmath>

namespace knead::tools {
namespace {

constexpr double kRecent_s = 0.1;

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

}  // namespace

void TouchMeter::see(const HapticTick& tick) noexcept {
    TouchTotals& t = totals_;
    ++t.ticks;
    t.seconds += tick.dt_s;
    t.force_n = std::sqrt(dot(tick.device_force_n, tick.device_force_n));
    t.scene_force_n = std::sqrt(dot(tick.scene_force_n, tick.scene_force_n));
    t.tool_depth_m = dot(minus(tick.tool.position_m, rest_m_), direction_);
    t.hand_depth_m = dot(minus(tick.hand.position_m, rest_m_), direction_);
    t.touched_nodes = tick.step.touched_nodes;
    t.largest_force_n = std::max(t.largest_force_n, t.force_n);
    t.largest_scene_force_n = std::max(t.largest_scene_force_n, t.scene_force_n);
    t.largest_tool_depth_m = std::max(t.largest_tool_depth_m, t.tool_depth_m);
    t.largest_hand_depth_m = std::max(t.largest_hand_depth_m, t.hand_depth_m);
    t.most_touched_nodes = std::max(t.most_touched_nodes, t.touched_nodes);
    count_energy(tick);
    count_status(tick);
}

void TouchMeter::count_energy(const HapticTick& tick) noexcept {
    const Vec3& here = tick.device.pose.position_m;
    if (totals_.ticks > 1) totals_.absorbed_j -= dot(held_n_, minus(here, last_m_));
    totals_.least_absorbed_j = std::min(totals_.least_absorbed_j, totals_.absorbed_j);
    held_n_ = tick.device_force_n;
    last_m_ = here;
}

void TouchMeter::count_status(const HapticTick& tick) noexcept {
    const auto count = [&](std::uint32_t bits, auto& ticks, std::size_t first) {
        std::uint32_t recent = 0;
        for (std::size_t bit = 0; bit < ticks.size(); ++bit) {
            const std::uint32_t mask = std::uint32_t{1} << bit;
            double& until_s = seen_until_s_[first + bit];
            if ((bits & mask) != 0) {
                ++ticks[bit];
                until_s = totals_.seconds + kRecent_s;
            }
            if (until_s > totals_.seconds) recent |= mask;
        }
        return recent;
    };
    totals_.recent_haptic_status = count(tick.status, totals_.haptic_status_ticks, 0);
    totals_.recent_step_status =
        count(tick.step.status, totals_.step_status_ticks, totals_.haptic_status_ticks.size());
}

}  // namespace knead::tools
