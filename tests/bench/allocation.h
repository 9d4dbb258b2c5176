// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace knead::bench {

/// Sanitizers need malloc for themselves: nothing is counted under them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kAllocationsAreCounted = false;
#else
inline constexpr bool kAllocationsAreCounted = true;
#endif

/// What the process has asked of malloc and its relatives (operator new included) since it started.
struct AllocationCount {
    std::uint64_t calls = 0;
    std::int64_t live_bytes = 0;  ///< usable bytes of blocks that are not freed
};

/// A program that calls this has its malloc replaced by one that counts (glibc only).
[[nodiscard]] AllocationCount allocation_count();

}  // namespace knead::bench
