// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace knead::tools {

/// Names of the HapticStatus and StepStatus bits, bit 0 first, as reports spell them.
inline constexpr std::array<const char*, 11> kHapticStatusNames{
    "saturated",    "not_finite", "passivity", "slew_limited", "ramping",    "stale_model",
    "stale_device", "bad_pose",   "pose_jump", "time_jump",    "step_failed"};
inline constexpr std::array<const char*, 5> kStepStatusNames{"not_converged", "step_not_finite", "bad_input",
                                                             "contact_cap", "inside_out"};

/// "ramping, slew limited, not converged", or "ok".
[[nodiscard]] std::string status_words(std::uint32_t haptic_status, std::uint32_t step_status);

}  // namespace knead::tools
