// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "knead/formats/result.h"
#include "knead/haptics/device.h"
#include "knead/haptics/export.h"
#include "knead/haptics/status.h"
#include "knead/haptics/workspace_map.h"
#include "knead/runtime/pose.h"
#include "knead/runtime/simulation.h"

namespace knead {

struct HapticConfig {
    WorkspaceMap workspace;
    double force_scale = 1;  ///< device newtons per scene newton, >= 0
    double max_force_n =
        3.3;  ///< largest norm of the force on the hand, > 0; the default suits a small desktop device
};

/// One period of the loop.
struct HapticTick {
    DeviceState device;                ///< as read
    Pose hand;                         ///< the same in the scene
    StepResult step;                   ///< forces in the scene
    Vec3 device_force_n{};             ///< as written
    std::uint32_t status = kHapticOk;  ///< HapticStatus bits
};

/// What a run was like.
struct RunStatistics {
    std::uint64_t ticks = 0;
    std::uint64_t misses = 0;  ///< ticks that ended after their period
    double longest_tick_s = 0;
    std::uint32_t step_status = 0;    ///< StepStatus bits of all ticks together
    std::uint32_t haptic_status = 0;  ///< HapticStatus bits of all ticks together
};

/// The haptic loop, synchronous: read the device, step the object, write the force.
///
/// Keeps references: device and simulation must outlive it. One thread at a time.
class KNEAD_HAPTICS_API HapticLoop {
  public:
    /// @return the loop, or invalid_argument for a config out of the documented ranges
    static Result<HapticLoop> create(Device& device, Simulation& simulation, const HapticConfig& config = {});

    /// One period: device -> workspace map -> step -> force scale -> limit of the norm -> non-finite to zero
    /// -> device. Never allocates, locks or throws (as far as the device does not).
    HapticTick tick(double dt_s) noexcept;

    /// Ticks for `seconds` at `rate_hz` on the calling thread, paced by the steady clock; then writes zero. A
    /// tick that ends late is a miss; the next one starts at once and the lost time is not caught up.
    /// @param rate_hz 50 to 4000, the simulation's range  @param observe called after each tick, inside its
    /// period
    /// @return statistics, or invalid_argument
    Result<RunStatistics> run(double seconds, double rate_hz,
                              const std::function<void(const HapticTick&)>& observe = {});

  private:
    HapticLoop(Device& device, Simulation& simulation, const HapticConfig& config) noexcept;

    Device* device_;
    Simulation* simulation_;
    HapticConfig config_;
};

}  // namespace knead
