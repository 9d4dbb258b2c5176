// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "haptics/clock.h"
#include "haptics/loop_impl.h"

namespace knead {
namespace {

constexpr double kLongestStep_s = 20e-3;  ///< Simulation::step()

std::int64_t period_ns(double rate_hz) noexcept {
    return std::llround(1e9 / rate_hz);
}

/// The first time of the schedule after `now`: what was lost is left out, in whole periods.
std::int64_t next_after(std::int64_t scheduled, std::int64_t period, std::int64_t now) noexcept {
    const std::int64_t next = scheduled + period;
    return next >= now ? next : next + ((now - next) / period + 1) * period;
}

}  // namespace

bool HapticLoop::Impl::start_helpers(ResultObserver seen) noexcept {
    recorder.clear();
    stop_simulation = false;
    if (!watch.start(config.realtime_priority)) return false;
    if (config.mode == HapticMode::synchronous) return true;
    try {
        simulation_thread = std::thread([this, observe = std::move(seen)] { run_simulation(observe); });
    } catch (const std::exception&) {
        watch.stop();
        return false;
    }
    return true;
}

void HapticLoop::Impl::stop_helpers() noexcept {
    stop_simulation = true;
    if (simulation_thread.joinable()) simulation_thread.join();
    watch.stop();
}

void HapticLoop::Impl::stop() noexcept {
    stop_ticks = true;
    if (haptic_thread.joinable()) haptic_thread.join();
}

void HapticLoop::Impl::run_ticks(std::uint64_t wanted, const Observer& observe) {
    const RealtimePriority priority(config.realtime_priority);
    recorder.set_priority(priority.given(), priority.error());
    const std::int64_t period = period_ns(config.rate_hz);
    std::int64_t scheduled = now_ns(), last = scheduled - period;
    for (std::uint64_t done = 0; done < wanted && !stop_ticks.load(std::memory_order_relaxed); ++done) {
        TickTimes times;
        const std::int64_t cpu = own_cpu_ns();
        times.scheduled = scheduled;
        times.begin = now_ns();
        const HapticTick tick = haptic.tick(1e-9 * static_cast<double>(scheduled - last), &times.step);
        times.end = now_ns();
        if (observe) observe(tick);
        const std::int64_t end = now_ns();
        times.missed = end > scheduled + period;
        if (times.missed) times.preempted = preempted(times, cpu < 0 ? -1 : own_cpu_ns() - cpu, period);
        recorder.add_tick(times, tick.status, tick.step.status);
        last = scheduled;
        scheduled = next_after(scheduled, period, end);
        sleep_until_ns(scheduled);
    }
    haptic.let_go();
}

/// A late tick is not ours when what it had to do took less than a period of the processor's time: it was
/// woken late, or something else ran in between. Nor when the watch was not run either, all the machine was
/// away then.
bool HapticLoop::Impl::preempted(const TickTimes& times, std::int64_t used_ns,
                                 std::int64_t period) const noexcept {
    if (used_ns >= 0 && used_ns < period) return true;
    return watch.stalled(times.scheduled, now_ns());
}

void HapticLoop::Impl::run_simulation(const ResultObserver& observe) noexcept {
    const std::int64_t period = period_ns(config.simulation_rate_hz);
    std::int64_t scheduled = now_ns(), last = scheduled - period;
    while (!stop_simulation.load(std::memory_order_relaxed)) {
        const std::int64_t begin = now_ns();
        const double dt_s = std::min(1e-9 * static_cast<double>(scheduled - last), kLongestStep_s);
        const SimulationResult result = simulation_side.simulate(dt_s);
        exchange.results.write(result);
        if (observe) observe(result);
        const std::int64_t end = now_ns();
        recorder.add_step(end - begin, end > scheduled + period, result.step.status);
        last = scheduled;
        scheduled = next_after(scheduled, period, end);
        sleep_until_ns(scheduled);
    }
}

}  // namespace knead
