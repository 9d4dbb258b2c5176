// SPDX-License-Identifier: Apache-2.0
#include "haptics/clock.h"

#include <cerrno>

#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#include <sched.h>
#include <time.h>
#define KNEAD_POSIX_THREADS 1
#endif

#include <chrono>
#include <thread>

namespace knead {

std::int64_t now_ns() noexcept {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

#if defined(__linux__)

void sleep_until_ns(std::int64_t when_ns) noexcept {
    // Absolute: what happens between reading the clock and going to sleep does not add up.
    const std::int64_t second = 1'000'000'000;
    const timespec when{static_cast<time_t>(when_ns / second), static_cast<long>(when_ns % second)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, nullptr) == EINTR) {
    }
}

std::int64_t own_cpu_ns() noexcept {
    timespec used{};
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used) != 0) return -1;
    return static_cast<std::int64_t>(used.tv_sec) * 1'000'000'000 + used.tv_nsec;
}

#else

void sleep_until_ns(std::int64_t when_ns) noexcept {
    std::this_thread::sleep_until(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(when_ns)));
}

std::int64_t own_cpu_ns() noexcept {
    return -1;
}

#endif

#if defined(KNEAD_POSIX_THREADS)

RealtimePriority::RealtimePriority(bool wanted) noexcept {
    if (!wanted) return;
    sched_param before{};
    error_ = pthread_getschedparam(pthread_self(), &old_policy_, &before);
    if (error_ != 0) return;
    old_priority_ = before.sched_priority;
    // Above ordinary real-time work, below what keeps the system itself alive.
    const int lowest = sched_get_priority_min(SCHED_FIFO), highest = sched_get_priority_max(SCHED_FIFO);
    sched_param wish{};
    wish.sched_priority = lowest + (highest - lowest) * 3 / 4;
    error_ = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wish);
    given_ = error_ == 0;
}

RealtimePriority::~RealtimePriority() {
    if (!given_) return;
    sched_param before{};
    before.sched_priority = old_priority_;
    (void)pthread_setschedparam(pthread_self(), old_policy_, &before);
}

#else

RealtimePriority::RealtimePriority(bool wanted) noexcept : error_(wanted ? ENOSYS : 0) {}
RealtimePriority::~RealtimePriority() = default;

#endif

}  // namespace knead
