// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "knead/formats/result.h"
#include "knead/runtime/device.h"
#include "knead/runtime/export.h"
#include "knead/runtime/pose.h"
#include "knead/runtime/simulation.h"

namespace knead {

/// From the device's frame to the scene's: position = offset + scale * rotation * device position. Forces
/// come back through the inverse rotation.
struct WorkspaceMap {
    double scale = 1;                                 ///< scene metres per device metre, > 0
    std::array<double, 4> rotation_wxyz{1, 0, 0, 0};  ///< unit quaternion
    Vec3 offset_m{};                                  ///< scene position of the device's origin
};

struct HapticConfig {
    WorkspaceMap workspace;
    double force_scale = 1;  ///< device newtons per scene newton, >= 0
    double max_force_n =
        3.3;  ///< largest norm of the force on the hand, > 0; the default suits a small desktop device
};

/// What happened in a tick, beside the step's own status; bits.
enum LoopStatus : std::uint32_t {
    kLoopOk = 0,
    kLoopSaturated = 1u << 0,  ///< the force was longer than the limit: shortened, its direction kept
    kLoopNotFinite = 1u << 1,  ///< the force was not finite: zero was written
};

/// One period of the loop.
struct HapticTick {
    DeviceState device;              ///< as read
    Pose hand;                       ///< the same in the scene
    StepResult step;                 ///< forces in the scene
    Vec3 device_force_n{};           ///< as written
    std::uint32_t status = kLoopOk;  ///< LoopStatus bits
};

/// What a run was like.
struct RunStatistics {
    std::uint64_t ticks = 0;
    std::uint64_t misses = 0;  ///< ticks that ended after their period
    double longest_tick_s = 0;
    std::uint32_t step_status = 0;  ///< StepStatus bits of all ticks together
    std::uint32_t loop_status = 0;  ///< LoopStatus bits of all ticks together
};

/// The haptic loop, synchronous: read the device, step the object, write the force.
///
/// Keeps references: device and simulation must outlive it. One thread at a time.
class KNEAD_RUNTIME_API HapticLoop {
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
