// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace knead {

/// How long something took, from a histogram whose bins are 3 % wide. Seconds.
struct DurationStatistics {
    std::uint64_t count = 0;
    double p50_s = 0;
    double p99_s = 0;
    double p999_s = 0;
    double max_s = 0;  ///< exact
};

/// What a run of the loop was like.
struct RunStatistics {
    std::uint64_t ticks = 0;
    double seconds = 0;             ///< from the first tick to the last
    double rate_hz = 0;             ///< reached
    double jitter_s = 0;            ///< root mean square of a tick's start against its schedule
    DurationStatistics haptic;      ///< of a tick without the simulation's step
    DurationStatistics tick;        ///< of a tick whole
    DurationStatistics simulation;  ///< of a step of the simulation with its local model

    std::uint64_t misses = 0;             ///< ticks that ended after their period
    std::uint64_t misses_preempted = 0;   ///< of them: the machine did not run us
    std::uint64_t misses_ours = 0;        ///< of them: the rest
    std::uint64_t simulation_misses = 0;  ///< two-rate: steps that took longer than their period
    double longest_tick_s = 0;            ///< from the schedule to the end

    bool realtime_priority = false;   ///< the haptic thread ran with it
    int realtime_error = 0;           ///< errno of the refusal; 0 when it was not asked for or was given
    std::uint32_t step_status = 0;    ///< StepStatus bits of all steps together
    std::uint32_t haptic_status = 0;  ///< HapticStatus bits of all ticks together
};

}  // namespace knead
