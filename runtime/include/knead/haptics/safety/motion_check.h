// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "knead/haptics/export.h"
#include "knead/runtime/pose.h"

namespace knead {

/// How a hand and a clock can move.
struct MotionLimits {
    double max_hand_speed_m_per_s = 5;     ///< > 0
    double max_turn_speed_rad_per_s = 50;  ///< > 0
    double slack_m = 1e-3;                 ///< added: noise, samples that come in pairs; >= 0
    double slack_rad = 0.02;               ///< likewise
    double max_dt_ratio = 8;               ///< longest period over the expected one, >= 1
};

/// What happened since the sample before.
struct Motion {
    std::uint32_t status = 0;  ///< kHapticBadPose, kHapticPoseJump, kHapticTimeJump, or 0
    Vec3 moved_m{};            ///< zero if there is no sample before, or with a status
    Vec3 turned_rad{};         ///< rotation vector in the frame of the poses; likewise
};

/// Tells what a hand cannot have done from what it did.
class KNEAD_HAPTICS_API MotionCheck {
  public:
    explicit MotionCheck(const MotionLimits& limits) noexcept : limits_(limits) {}

    /// Bad pose: not finite, or the quaternion's norm is not 1 within 1e-3. Pose jump: farther than the speed
    /// limits allow in the time between the two samples. Time jump: a period that is not above zero, or above
    /// max_dt_ratio expected ones (one that is too short does no harm), or an expected one out of 1e-5 to 0.1
    /// s.
    /// @param sample_age_s of this pose: a device that gave no new sample for a while may have moved
    /// meanwhile
    [[nodiscard]] Motion observe(const Pose& pose, double dt_s, double expected_dt_s,
                                 double sample_age_s) noexcept;

    /// The next pose is a first one.
    void reset() noexcept { has_last_ = false; }

  private:
    MotionLimits limits_;
    Pose last_;
    double last_age_s_ = 0;
    bool has_last_ = false;
};

}  // namespace knead
