// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace knead {

/// Monotonic, nanoseconds.
[[nodiscard]] std::int64_t now_ns() noexcept;
/// Returns at once if that is over.
void sleep_until_ns(std::int64_t when_ns) noexcept;
/// How long this thread has run, nanoseconds; below zero where the system does not tell.
[[nodiscard]] std::int64_t own_cpu_ns() noexcept;

/// Gives the calling thread real-time priority as long as it lives, and then what it had.
class RealtimePriority {
  public:
    /// @param wanted false: does nothing
    explicit RealtimePriority(bool wanted) noexcept;
    ~RealtimePriority();
    RealtimePriority(const RealtimePriority&) = delete;
    RealtimePriority& operator=(const RealtimePriority&) = delete;

    [[nodiscard]] bool given() const noexcept { return given_; }
    [[nodiscard]] int error() const noexcept { return error_; }  ///< errno of the refusal, or 0

  private:
    bool given_ = false;
    int error_ = 0;
    int old_policy_ = 0;
    int old_priority_ = 0;
};

}  // namespace knead
