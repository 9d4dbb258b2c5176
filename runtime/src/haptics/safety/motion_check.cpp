// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/safety/motion_check.h"

#include <algorithm>
#include <cmath>

#include "haptics/quaternion.h"
#include "knead/haptics/safety/norm_limit.h"
#include "knead/haptics/safety/watchdog.h"
#include "knead/haptics/status.h"

namespace knead {
namespace {

constexpr double kShortestPeriod_s = 1e-5;
constexpr double kLongestPeriod_s = 0.1;

bool good(const Pose& pose) noexcept {
    return std::isfinite(norm(pose.position_m)) && is_unit(pose.orientation_wxyz);
}

bool good(double dt_s, double expected_dt_s, double max_ratio) noexcept {
    if (!(expected_dt_s >= kShortestPeriod_s && expected_dt_s <= kLongestPeriod_s)) return false;
    return dt_s > 0 && dt_s <= max_ratio * expected_dt_s;
}

/// The shorter way round. Lengths of the quaternions cancel.
Vec3 rotation_vector(const QuaternionWxyz& from, const QuaternionWxyz& to) noexcept {
    const QuaternionWxyz turn = multiply(to, inverse(from));
    const Vec3 axis{turn[1], turn[2], turn[3]};
    const double sine = norm(axis);
    if (!(sine > 0)) return {};
    const double angle = 2 * std::atan2(sine, std::abs(turn[0]));
    const double factor = std::copysign(angle / sine, turn[0]);
    return {factor * axis[0], factor * axis[1], factor * axis[2]};
}

}  // namespace

Motion MotionCheck::observe(const Pose& pose, double dt_s, double expected_dt_s,
                            double sample_age_s) noexcept {
    Motion motion;
    if (!good(dt_s, expected_dt_s, limits_.max_dt_ratio)) motion.status |= kHapticTimeJump;
    if (!good(pose)) {
        motion.status |= kHapticBadPose;
        reset();
        return motion;
    }
    if (has_last_ && motion.status == 0) {
        const double time_s = dt_s + last_age_s_;
        for (std::size_t axis = 0; axis < 3; ++axis)
            motion.moved_m[axis] = pose.position_m[axis] - last_.position_m[axis];
        motion.turned_rad = rotation_vector(last_.orientation_wxyz, pose.orientation_wxyz);
        const bool possible =
            norm(motion.moved_m) <= limits_.max_hand_speed_m_per_s * time_s + limits_.slack_m &&
            norm(motion.turned_rad) <= limits_.max_turn_speed_rad_per_s * time_s + limits_.slack_rad;
        if (!possible) motion = {kHapticPoseJump, {}, {}};
    }
    last_ = pose;
    // An age that is no age, or longer than any force outlives its sample, allows nothing more.
    last_age_s_ = sample_age_s > 0 ? std::min(sample_age_s, Watchdog::kLongestSilence_s) : 0;
    has_last_ = true;
    return motion;
}

}  // namespace knead
