// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace knead {

/// Hands the newest value from one thread to another. Wait-free on both sides: one atomic exchange each, no
/// loop, no lock. Values that nobody read in time are lost; a value is never read half written.
///
/// One writing and one reading thread. Three slots: the writer fills its own, the reader reads its own, the
/// third lies between and changes hands.
template <class T>
class TripleBuffer {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    /// The writer's side.
    void write(const T& value) noexcept {
        slots_[back_] = value;
        back_ = between_.exchange(static_cast<std::uint8_t>(back_ | kNew), std::memory_order_acq_rel) & kSlot;
    }

    /// The reader's side. @param out the newest value, or as it was @return whether there was a new one
    bool read(T& out) noexcept {
        if ((between_.load(std::memory_order_relaxed) & kNew) == 0) return false;
        front_ = between_.exchange(front_, std::memory_order_acq_rel) & kSlot;
        out = slots_[front_];
        return true;
    }

  private:
    static constexpr std::uint8_t kSlot = 3;
    static constexpr std::uint8_t kNew = 4;

    std::array<T, 3> slots_{};
    alignas(64) std::atomic<std::uint8_t> between_{1};
    alignas(64) std::uint8_t back_ = 0;   ///< the writer's
    alignas(64) std::uint8_t front_ = 2;  ///< the reader's
};

}  // namespace knead
