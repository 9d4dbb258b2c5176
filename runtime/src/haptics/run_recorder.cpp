// SPDX-License-Identifier: Apache-2.0
#include "haptics/run_recorder.h"

#include <algorithm>
#include <cmath>

namespace knead {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

std::uint64_t duration(std::int64_t ns) noexcept {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0));
}

}  // namespace

void RunRecorder::clear() noexcept {
    for (DurationHistogram* histogram : {&haptic_, &tick_, &simulation_})
        histogram->clear();
    for (auto* count : {&ticks_, &misses_, &preempted_, &simulation_misses_})
        count->store(0, kRelaxed);
    for (auto* time : {&first_ns_, &last_ns_, &longest_ns_})
        time->store(0, kRelaxed);
    for (auto* bits : {&haptic_status_, &tick_step_status_, &step_status_})
        bits->store(0, kRelaxed);
    squared_lateness_.store(0, kRelaxed);
    set_priority(false, 0);
}

void RunRecorder::set_priority(bool given, int error) noexcept {
    realtime_.store(given, kRelaxed);
    realtime_error_.store(error, kRelaxed);
}

void RunRecorder::add_tick(const TickTimes& times, std::uint32_t haptic_status,
                           std::uint32_t step_status) noexcept {
    if (ticks_.load(kRelaxed) == 0) first_ns_.store(times.begin, kRelaxed);
    last_ns_.store(times.begin, kRelaxed);
    add(ticks_, std::uint64_t{1});
    tick_.add(duration(times.end - times.begin));
    haptic_.add(duration(times.end - times.begin - times.step));
    if (times.step > 0) simulation_.add(duration(times.step));
    const auto late = static_cast<double>(times.begin - times.scheduled);
    add(squared_lateness_, late * late);
    longest_ns_.store(std::max(longest_ns_.load(kRelaxed), times.end - times.scheduled), kRelaxed);
    if (times.missed) {
        add(misses_, std::uint64_t{1});
        if (times.preempted) add(preempted_, std::uint64_t{1});
    }
    haptic_status_.store(haptic_status_.load(kRelaxed) | haptic_status, kRelaxed);
    tick_step_status_.store(tick_step_status_.load(kRelaxed) | step_status, kRelaxed);
}

void RunRecorder::add_step(std::int64_t ns, bool missed, std::uint32_t step_status) noexcept {
    simulation_.add(duration(ns));
    if (missed) add(simulation_misses_, std::uint64_t{1});
    step_status_.store(step_status_.load(kRelaxed) | step_status, kRelaxed);
}

RunStatistics RunRecorder::statistics() const noexcept {
    RunStatistics s;
    s.ticks = ticks_.load(kRelaxed);
    s.seconds = 1e-9 * static_cast<double>(last_ns_.load(kRelaxed) - first_ns_.load(kRelaxed));
    if (s.ticks > 1 && s.seconds > 0) s.rate_hz = static_cast<double>(s.ticks - 1) / s.seconds;
    if (s.ticks > 0)
        s.jitter_s = 1e-9 * std::sqrt(squared_lateness_.load(kRelaxed) / static_cast<double>(s.ticks));
    s.haptic = haptic_.statistics();
    s.tick = tick_.statistics();
    s.simulation = simulation_.statistics();
    s.misses = misses_.load(kRelaxed);
    s.misses_preempted = std::min(s.misses, preempted_.load(kRelaxed));
    s.misses_ours = s.misses - s.misses_preempted;
    s.simulation_misses = simulation_misses_.load(kRelaxed);
    s.longest_tick_s = 1e-9 * static_cast<double>(longest_ns_.load(kRelaxed));
    s.realtime_priority = realtime_.load(kRelaxed);
    s.realtime_error = realtime_error_.load(kRelaxed);
    s.haptic_status = haptic_status_.load(kRelaxed);
    s.step_status = step_status_.load(kRelaxed) | tick_step_status_.load(kRelaxed);
    return s;
}

}  // namespace knead
