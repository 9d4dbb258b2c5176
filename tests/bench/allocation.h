// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace knead::bench {

/// What the process has asked of malloc and its relatives (operator new included) since it started.
struct AllocationCount {
    std::uint64_t calls = 0;
    std::int64_t live_bytes = 0;  ///< usable bytes of blocks that are not freed
};

/// A program that calls this has its malloc replaced by one that counts (glibc only).
[[nodiscard]] AllocationCount allocation_count();

}  // namespace knead::bench
