// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "haptics/duration_histogram.h"
#include "knead/haptics/run_statistics.h"

namespace knead {

/// One tick as the clock saw it, nanoseconds.
struct TickTimes {
    std::int64_t scheduled = 0, begin = 0, end = 0;
    std::int64_t step = 0;  ///< of the simulation, in this tick
    bool missed = false, preempted = false;
};

/// Collects RunStatistics. The haptic thread adds ticks, the simulation thread adds steps, any thread reads:
/// all by plain loads and stores of atomics that have one writer each.
class RunRecorder {
  public:
    /// Not while threads add.
    void clear() noexcept;
    void set_priority(bool given, int error) noexcept;
    void add_tick(const TickTimes& times, std::uint32_t haptic_status, std::uint32_t step_status) noexcept;
    void add_step(std::int64_t ns, bool missed, std::uint32_t step_status) noexcept;
    [[nodiscard]] RunStatistics statistics() const noexcept;

  private:
    template <class T>
    static void add(std::atomic<T>& to, T more) noexcept {
        to.store(to.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
    }

    DurationHistogram haptic_, tick_, simulation_;
    std::atomic<std::uint64_t> ticks_{0}, misses_{0}, preempted_{0}, simulation_misses_{0};
    std::atomic<std::int64_t> first_ns_{0}, last_ns_{0}, longest_ns_{0};
    std::atomic<double> squared_lateness_{0};  ///< ns^2
    std::atomic<std::uint32_t> haptic_status_{0}, tick_step_status_{0}, step_status_{0};
    std::atomic<bool> realtime_{false};
    std::atomic<int> realtime_error_{0};
};

}  // namespace knead
