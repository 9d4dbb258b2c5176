// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Counts what a haptic step must not do: the program that links watched_calls.cpp has its own malloc, free,
/// operator new, pthread_mutex_lock and so on, which count and go on to the C library's. The libraries that
/// the program loads call them too.
namespace knead::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
/// A sanitizer has replaced the same functions; only operator new is counted then.
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

struct WatchedCalls {
    long allocations = 0;  ///< malloc, calloc, realloc, posix_memalign, aligned_alloc, memalign, operator new
    long frees = 0;
    long locks = 0;  ///< mutexes, read-write locks, spin locks, semaphores, condition variables: also tries
};

/// All of this program so far, all its threads together.
[[nodiscard]] WatchedCalls watched_calls() noexcept;

inline WatchedCalls operator-(const WatchedCalls& a, const WatchedCalls& b) {
    return {a.allocations - b.allocations, a.frees - b.frees, a.locks - b.locks};
}

}  // namespace knead::test
