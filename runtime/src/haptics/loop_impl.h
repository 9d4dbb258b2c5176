// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "haptics/haptic_side.h"
#include "haptics/machine_watch.h"
#include "haptics/run_recorder.h"
#include "haptics/simulation_side.h"
#include "knead/haptics/haptic_loop.h"

namespace knead {

/// The two sides, and the threads that drive them.
struct HapticLoop::Impl {
    Impl(Device& device, Simulation& simulation, const HapticConfig& loop_config,
         const SafetyChain& safety) noexcept
        : config(loop_config),
          haptic(device, simulation, loop_config, safety, exchange),
          simulation_side(simulation, exchange) {}
    ~Impl() { stop(); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    using Observer = std::function<void(const HapticTick&)>;
    using ResultObserver = std::function<void(const SimulationResult&)>;

    /// Threads beside the haptic one. @return false when the system gives none: then none is left
    bool start_helpers(ResultObserver seen) noexcept;
    void stop_helpers() noexcept;
    /// Ticks on this thread until as many are done or stop_ticks is set; then zero force.
    void run_ticks(std::uint64_t wanted, const Observer& observe);
    void stop() noexcept;

    HapticConfig config;
    Exchange exchange;
    HapticSide haptic;
    SimulationSide simulation_side;
    RunRecorder recorder;

    MachineWatch watch;
    std::thread haptic_thread, simulation_thread;
    std::atomic<bool> running{false};  ///< between the start and the end of a run
    std::atomic<bool> stop_ticks{false};
    std::atomic<bool> stop_simulation{false};

  private:
    void run_simulation(const ResultObserver& observe) noexcept;
    [[nodiscard]] bool preempted(const TickTimes& times, std::int64_t own_cpu_ns,
                                 std::int64_t period_ns) const noexcept;
};

}  // namespace knead
