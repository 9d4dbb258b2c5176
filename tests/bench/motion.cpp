// SPDX-License-Identifier: Apache-2.0
#include "bench/motion.h"

#include <algorithm>
#include <cmath>

namespace knead::bench {
namespace {

constexpr double kTremorHz = 10;
constexpr double kTremorM = 0.3e-3;
/// Sideways the hand trembles less and at other frequencies, so that no two periods are alike.
constexpr double kSideTremorM = 0.1e-3;
constexpr double kSideTremorXHz = 8.5;
constexpr double kSideTremorYHz = 11.3;

double tremor(double amplitude_m, double frequency_hz, double time_s, double phase_rad) {
    const double angle = 2 * M_PI * frequency_hz * time_s;
    return amplitude_m * (std::sin(angle + phase_rad) - std::sin(phase_rad));
}

/// 0 to 1 in `ramp_s`, 1 for `hold_s`, back to 0 in `ramp_s`, then 0.
double there_and_back(double time_s, double ramp_s, double hold_s) {
    const double up = time_s / ramp_s;
    const double down = (2 * ramp_s + hold_s - time_s) / ramp_s;
    return std::clamp(std::min(up, down), 0.0, 1.0);
}

}  // namespace

Motion press(double way_m, double speed_m_per_s, double duration_s, double phase_rad) {
    const auto pose = [=](const Pose& rest, double time_s) {
        Pose p = rest;
        p.position_m[0] += tremor(kSideTremorM, kSideTremorXHz, time_s, phase_rad);
        p.position_m[1] += tremor(kSideTremorM, kSideTremorYHz, time_s, 2 * phase_rad);
        p.position_m[2] -= std::min(way_m, speed_m_per_s * time_s);
        p.position_m[2] += tremor(kTremorM, kTremorHz, time_s, phase_rad);
        return p;
    };
    return {pose, duration_s};
}

Motion press_and_release(double way_m, double press_s, double hold_s, double rest_s) {
    const auto pose = [=](const Pose& rest, double time_s) {
        Pose p = rest;
        p.position_m[2] -= way_m * there_and_back(time_s, press_s, hold_s);
        return p;
    };
    return {pose, 2 * press_s + hold_s + rest_s};
}

Motion press_and_twist(double way_m, double speed_m_per_s, double angle_rad, double turn_s, double hold_s) {
    const double press_s = way_m / speed_m_per_s;
    const auto pose = [=](const Pose& rest, double time_s) {
        Pose p = rest;
        p.position_m[2] -= std::min(way_m, speed_m_per_s * time_s);
        const double half = 0.5 * angle_rad * there_and_back(time_s - press_s, turn_s, hold_s);
        p.orientation_wxyz = {std::cos(half), 0, 0, std::sin(half)};  // the bench's tools rest at identity
        return p;
    };
    return {pose, press_s + 2 * (turn_s + hold_s)};
}

}  // namespace knead::bench
