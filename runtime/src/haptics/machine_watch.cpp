// SPDX-License-Identifier: Apache-2.0
#include "haptics/machine_watch.h"

#include <algorithm>
#include <exception>

#include "haptics/clock.h"

namespace knead {
namespace {

constexpr std::int64_t kPeriod_ns = 250'000;
/// Timers are late by a few tens of microseconds on a machine at rest.
constexpr std::int64_t kStall_ns = 2 * kPeriod_ns;

}  // namespace

bool MachineWatch::start(bool realtime) noexcept {
    stop_ = false;
    last_wake_ns_ = now_ns();
    gap_begin_ns_ = gap_end_ns_ = 0;
    try {
        thread_ = std::thread([this, realtime] { watch(realtime); });
    } catch (const std::exception&) {
        return false;
    }
    return true;
}

void MachineWatch::stop() noexcept {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
}

void MachineWatch::watch(bool realtime) noexcept {
    const RealtimePriority priority(realtime);
    std::int64_t next = now_ns();
    while (!stop_.load(std::memory_order_relaxed)) {
        next += kPeriod_ns;
        sleep_until_ns(next);
        const std::int64_t now = now_ns();
        if (now - next > kStall_ns - kPeriod_ns) {
            gap_end_ns_.store(now, std::memory_order_relaxed);
            gap_begin_ns_.store(next, std::memory_order_relaxed);
        }
        last_wake_ns_.store(now, std::memory_order_release);
        next = std::max(next, now);
    }
}

bool MachineWatch::stalled(std::int64_t from_ns, std::int64_t to_ns) const noexcept {
    const std::int64_t last = last_wake_ns_.load(std::memory_order_acquire);
    if (last == 0) return false;
    if (to_ns - last > kStall_ns) return true;  // it sleeps on while we run
    const std::int64_t begin = gap_begin_ns_.load(std::memory_order_relaxed);
    const std::int64_t end = gap_end_ns_.load(std::memory_order_relaxed);
    return begin < to_ns && end > from_ns;
}

}  // namespace knead
