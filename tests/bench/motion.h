// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "knead/runtime/pose.h"

namespace knead::bench {

/// A tool's way in time from its rest pose; a cold start: at full speed from the first step on.
struct Motion {
    std::function<Pose(const Pose& rest, double time_s)> pose;
    double duration_s = 0;
};

/// Down by `way_m` at a constant speed, then held; a hand's tremor on top (10 Hz, 0.3 mm, and a third of that
/// sideways) that starts at any phase but without a jump.
[[nodiscard]] Motion press(double way_m, double speed_m_per_s, double duration_s, double phase_rad);

/// Down, held, up again, then at rest; the times are those of the four parts. No tremor.
[[nodiscard]] Motion press_and_release(double way_m, double press_s, double hold_s, double rest_s);

/// Down by `way_m` at a constant speed and, from there, turned about z through the tool's position, held,
/// turned back, held. (A turn alone has hardly any force to be right about: its parts cancel.)
[[nodiscard]] Motion press_and_twist(double way_m, double speed_m_per_s, double angle_rad, double turn_s,
                                     double hold_s);

}  // namespace knead::bench
