// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

namespace knead {

/// A thread of the haptic thread's priority that does nothing but wake up and look at the clock: where it was
/// not run, the machine was busy with something else, not we with the force.
class MachineWatch {
  public:
    MachineWatch() = default;
    ~MachineWatch() { stop(); }
    MachineWatch(const MachineWatch&) = delete;
    MachineWatch& operator=(const MachineWatch&) = delete;

    /// @return false when the system gives no thread
    bool start(bool realtime) noexcept;
    void stop() noexcept;

    /// Whether it was not run for long at some time between these two, as far as it is known now. From the
    /// haptic thread; wait-free.
    [[nodiscard]] bool stalled(std::int64_t from_ns, std::int64_t to_ns) const noexcept;

  private:
    void watch(bool realtime) noexcept;

    std::thread thread_;
    std::atomic<bool> stop_{false};
    std::atomic<std::int64_t> last_wake_ns_{0};
    std::atomic<std::int64_t> gap_begin_ns_{0}, gap_end_ns_{0};  ///< the last one
};

}  // namespace knead
