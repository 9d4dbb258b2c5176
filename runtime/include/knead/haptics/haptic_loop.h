// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "knead/formats/result.h"
#include "knead/haptics/coupling.h"
#include "knead/haptics/device.h"
#include "knead/haptics/export.h"
#include "knead/haptics/run_statistics.h"
#include "knead/haptics/safety.h"
#include "knead/haptics/simulation_result.h"
#include "knead/haptics/status.h"
#include "knead/haptics/workspace_map.h"
#include "knead/runtime/config.h"
#include "knead/runtime/pose.h"
#include "knead/runtime/simulation.h"

namespace knead {

/// Where the simulation's step runs.
enum class HapticMode : std::uint8_t {
    synchronous = 0,  ///< in the haptic period: where it fits
    two_rate = 1      ///< in a thread of its own; the haptic side renders from its newest result
};

/// What the haptic side of a two-rate loop makes of the newest result. The last two are here for comparison
/// and for engines that know nothing else: stiff contact is not stable with them.
enum class LocalRendering : std::uint8_t {
    reduced_object = 0,  ///< ReducedObject
    linear = 1,          ///< the result's force and its change with the hand (LinearView behind the coupling)
    hold = 2             ///< the result's force until the next one
};

struct HapticConfig {
    WorkspaceMap workspace;
    double force_scale = 1;  ///< device newtons per scene newton, >= 0
    double rate_hz = 1000;   ///< of the haptic side, 500 to 4000
    HapticMode mode = HapticMode::synchronous;
    double simulation_rate_hz = 120;  ///< two-rate: steps asked for per second, 50 to 4000
    LocalRendering rendering = LocalRendering::reduced_object;
    double correction_gain = 0.2;  ///< ReducedObject::Config::correction_gain
    CouplingConfig coupling;
    SafetyConfig safety;
    bool realtime_priority = true;  ///< asked for; RunStatistics tells whether it was given
};

/// The configuration a Simulation must be made with to be touched by a loop of `config`: expected step,
/// coupling, torque and local model are set, everything else is of `base`. A simulation made otherwise works
/// as it can: without its coupling a synchronous loop puts the tool where the hand is; without a local model
/// a two-rate loop is stale.
[[nodiscard]] KNEAD_HAPTICS_API SimulationConfig simulation_config(const HapticConfig& config,
                                                                   SimulationConfig base = {});

/// One period of the loop. Plain data: enough to replay it.
struct HapticTick {
    std::uint64_t number = 0;  ///< since the loop was made, from 1
    double dt_s = 0;
    DeviceState device;                ///< as read
    Pose hand;                         ///< the same in the scene; the last good one if it was bad
    Pose tool;                         ///< where the tool is (the proxy), scene frame
    std::uint64_t model = 0;           ///< two-rate: SimulationResult::number rendered from; 0: none yet
    StepResult step;                   ///< synchronous: of this period; two-rate: of that result
    Vec3 scene_force_n{};              ///< on the hand, scene frame, before scale and safety
    Vec3 scene_torque_nm{};            ///< likewise
    Vec3 device_force_n{};             ///< as written
    Vec3 device_torque_nm{};           ///< as written
    std::uint32_t status = kHapticOk;  ///< HapticStatus bits
};

/// The haptic loop: read the device, render the object through the coupling, keep it safe, write the force.
///
/// Two ways to drive it, never both at once:
///   - by own clocks: run() on the calling thread, or start() and stop(); two-rate adds a simulation thread
///   - in virtual time, without threads: tick() for each haptic period; two-rate also simulate() for each
///   step of the
///     simulation and publish() when its result is to arrive. The same calls give the same bits.
/// Keeps references: device and simulation must outlive it. Another object: stop(), which ends with zero
/// force; then a new loop with the new simulation, whose force rises from zero by the safety chain's ramp.
class KNEAD_HAPTICS_API HapticLoop {
  public:
    /// Allocates everything the loop needs. @return the loop, or invalid_argument for a config out of the
    /// documented ranges or a simulation without exactly one tool
    static Result<HapticLoop> create(Device& device, Simulation& simulation, const HapticConfig& config = {});
    HapticLoop(HapticLoop&&) noexcept;
    HapticLoop& operator=(HapticLoop&&) noexcept;
    ~HapticLoop();  ///< ends the threads, as stop()

    /// One haptic period, as long as dt_s. Never allocates, locks or throws (as far as the device does not).
    HapticTick tick(double dt_s) noexcept;
    /// Two-rate: one step of the simulation from the newest tick's pose. Likewise without allocation or lock.
    SimulationResult simulate(double dt_s) noexcept;
    /// Two-rate: hands a result to the haptic side; the next tick renders from it. Wait-free.
    void publish(const SimulationResult& result) noexcept;

    /// Ticks for `seconds` on the calling thread, paced by the clock, then writes zero force. A tick that
    /// ends late is a miss; the next one starts at the next full period, lost time is not caught up.
    /// @param observe called after each tick, inside its period; must be as quick as the loop is to be, and
    /// not throw
    /// @param observe_result two-rate: likewise after each step, on the simulation's thread
    /// @return statistics, or invalid_argument; running already is invalid_argument, too
    Result<RunStatistics> run(double seconds, const std::function<void(const HapticTick&)>& observe = {},
                              const std::function<void(const SimulationResult&)>& observe_result = {});

    /// The same on threads of its own until stop(). @return invalid_argument when it runs already,
    /// out_of_memory when the system gives no thread
    Status start(std::function<void(const HapticTick&)> observe = {},
                 std::function<void(const SimulationResult&)> observe_result = {});
    /// Ends the threads, or a run() on another thread after its tick; writes zero force, also in virtual
    /// time. The next tick starts the safety chain's ramp from zero.
    void stop() noexcept;
    [[nodiscard]] bool running() const noexcept;
    /// Of the run that is on, or of the last one. From any thread, at any time.
    [[nodiscard]] RunStatistics statistics() const noexcept;

  private:
    struct Impl;
    explicit HapticLoop(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace knead
