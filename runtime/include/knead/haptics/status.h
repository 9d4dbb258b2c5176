// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace knead {

/// What acted on the force of one haptic tick, beside the step's own status; bits, never renumbered.
enum HapticStatus : std::uint32_t {
    kHapticOk = 0,
    kHapticSaturated = 1u << 0,    ///< force or torque was longer than its limit: shortened, direction kept
    kHapticNotFinite = 1u << 1,    ///< the force was not finite: zero was written
    kHapticPassivity = 1u << 2,    ///< the passivity controller took energy out
    kHapticSlewLimited = 1u << 3,  ///< the force would have changed faster than allowed
    kHapticRamping = 1u << 4,      ///< rising after engaging or after a jump
    kHapticStaleModel = 1u << 5,   ///< no new result of the simulation for too long: fading, then zero
    kHapticStaleDevice = 1u << 6,  ///< no new sample of the device for too long: fading, then zero
    kHapticBadPose = 1u << 7,      ///< the device's pose was not finite or not a pose: zero was written
    kHapticPoseJump = 1u << 8,     ///< the device moved farther than a hand can: ramp starts again
    kHapticTimeJump = 1u << 9,     ///< the period was far from the expected one: ramp starts again
    kHapticStepFailed = 1u << 10,  ///< the simulation said not finite or bad input: its force is not used
};

}  // namespace knead
