// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "haptics/triple_buffer.h"
#include "haptics/turning_tool.h"
#include "knead/haptics/haptic_loop.h"
#include "knead/haptics/reduced_object.h"

namespace knead {

/// What the haptic side tells the simulation: where the hand is.
struct HandSample {
    std::uint64_t tick = 0;  ///< 0: nothing known
    Pose pose;  ///< of the hand as it is expected to be, with the orientation of the tool; scene frame
};

/// What passes between the two sides of a two-rate loop.
struct Exchange {
    TripleBuffer<HandSample> hands;
    TripleBuffer<SimulationResult> results;
};

/// One haptic period after the other: device, workspace map, rendering, scale, safety, device.
///
/// Used by one thread at a time. Never allocates, locks or throws.
class HapticSide {
  public:
    /// @param simulation stepped here when synchronous, otherwise not touched
    HapticSide(Device& device, Simulation& simulation, const HapticConfig& config, const SafetyChain& safety,
               Exchange& exchange) noexcept;

    /// @param step_ns if not null: how long the simulation's step took, in it
    HapticTick tick(double dt_s, std::int64_t* step_ns = nullptr) noexcept;
    /// No force: the device is on its own from here on, and the ramp starts from zero.
    void let_go() noexcept;

  private:
    bool take_hand(const DeviceState& sample, double dt_s) noexcept;
    void step(HapticTick& tick) noexcept;
    void render(HapticTick& tick) noexcept;
    void take_result(double dt_s, std::uint32_t& status) noexcept;
    [[nodiscard]] Pose expected_hand(double dt_s) noexcept;
    [[nodiscard]] Wrench rendered(double dt_s) noexcept;

    static constexpr std::size_t kTimes = 256;

    Device* device_;
    Simulation* simulation_;
    HapticConfig config_;
    SafetyChain safety_;
    Exchange* exchange_;

    std::uint64_t tick_ = 0;
    bool has_hand_ = false;
    Pose hand_;  ///< the last good one, scene frame
    double sample_time_s_ = std::numeric_limits<double>::quiet_NaN();
    double sample_age_s_ = 0;

    // Synchronous.
    TurningTool turning_;
    LocalModel model_;
    int ticks_to_model_ = 0;
    std::uint32_t model_touched_ = 0;

    // Two-rate.
    ReducedObject reduced_;
    SimulationResult result_;
    LinearView view_;
    double model_age_s_ = std::numeric_limits<double>::infinity();
    bool step_failed_ = false;
    double time_s_ = 0;        ///< sum of the periods
    double result_age_s_ = 0;  ///< of the newest result's pose, when it arrived
    Pose last_hand_;
    Vec3 hand_velocity_m_per_s_{};               ///< smoothed
    std::array<double, kTimes> tick_times_s_{};  ///< ring by number
};

}  // namespace knead
