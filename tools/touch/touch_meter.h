// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "knead/haptics/haptic_loop.h"
#include "touch/status_words.h"

namespace knead::tools {

/// How a touch has gone so far: what a screen shows and what a summary says. Plain data, so that the haptic
/// thread can hand it over whole.
///
/// Depths are along the press, from the tool's rest pose, scene frame. Energy is that of the translation:
/// what went from the hand into the object, less what came back; exact, for a force is held from one sample
/// to the next.
struct TouchTotals {
    std::uint64_t ticks = 0;
    double seconds = 0;  ///< sum of the periods

    double force_n = 0;                         ///< now, on the device
    double scene_force_n = 0;                   ///< now, before scaling and safety
    double tool_depth_m = 0, hand_depth_m = 0;  ///< now
    std::uint32_t touched_nodes = 0;
    std::uint32_t recent_haptic_status = 0;  ///< bits seen in the last tenth of a second
    std::uint32_t recent_step_status = 0;

    double largest_force_n = 0, largest_scene_force_n = 0;
    double largest_tool_depth_m = 0, largest_hand_depth_m = 0;
    std::uint32_t most_touched_nodes = 0;
    double absorbed_j = 0;
    double least_absorbed_j =
        0;  ///< smallest value of absorbed_j; below zero: the hand had got more than it gave
    std::array<std::uint64_t, kHapticStatusNames.size()> haptic_status_ticks{};  ///< ticks with each bit
    std::array<std::uint64_t, kStepStatusNames.size()> step_status_ticks{};

    [[nodiscard]] double saturated_share() const {
        return ticks == 0 ? 0 : static_cast<double>(haptic_status_ticks[0]) / static_cast<double>(ticks);
    }
};

/// Sees every tick of a loop. Never allocates, locks or throws.
class TouchMeter {
  public:
    /// @param rest where depths start  @param direction of the press, unit, scene frame
    TouchMeter(const Vec3& rest_m, const Vec3& direction) noexcept : rest_m_(rest_m), direction_(direction) {}

    void see(const HapticTick& tick) noexcept;
    [[nodiscard]] const TouchTotals& totals() const noexcept { return totals_; }

  private:
    static constexpr std::size_t kBits = kHapticStatusNames.size() + kStepStatusNames.size();
    void count_energy(const HapticTick& tick) noexcept;
    void count_status(const HapticTick& tick) noexcept;

    Vec3 rest_m_, direction_;
    TouchTotals totals_;
    Vec3 held_n_{}, last_m_{};
    std::array<double, kBits> seen_until_s_{};  ///< for each bit: when it stops being recent
};

}  // namespace knead::tools
