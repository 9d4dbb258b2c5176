// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace knead::tools {

/// The newest value of one writer, for readers that may wait: a sequence lock.
///
/// write() is wait-free: a handful of plain stores, for the haptic thread. read() tries again while a write
/// is under way. One writer at a time, any number of readers. Words are stored with release and loaded with
/// acquire order: who sees a word of a newer value also sees that its write has begun.
template <class T>
class Snapshot {
    static_assert(std::is_trivially_copyable_v<T>);

  public:
    void write(const T& value) noexcept {
        std::array<std::uint64_t, kWords> raw{};
        std::memcpy(raw.data(), &value, sizeof value);
        const std::uint64_t sequence = sequence_.load(std::memory_order_relaxed);
        sequence_.store(sequence + 1, std::memory_order_relaxed);
        for (std::size_t i = 0; i < kWords; ++i)
            words_[i].store(raw[i], std::memory_order_release);
        sequence_.store(sequence + 2, std::memory_order_release);
    }

    /// @return the newest whole value; all bytes zero before the first write
    [[nodiscard]] T read() const noexcept {
        std::array<std::uint64_t, kWords> raw{};
        for (;;) {
            const std::uint64_t before = sequence_.load(std::memory_order_acquire);
            for (std::size_t i = 0; i < kWords; ++i)
                raw[i] = words_[i].load(std::memory_order_acquire);
            if (before % 2 == 0 && sequence_.load(std::memory_order_relaxed) == before) break;
        }
        T value;
        std::memcpy(static_cast<void*>(&value), raw.data(), sizeof value);
        return value;
    }

  private:
    static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
    std::atomic<std::uint64_t> sequence_{0};
    std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace knead::tools
