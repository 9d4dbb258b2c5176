// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "baseline/statistics.h"
#include "bench/accuracy.h"
#include "bench/cost.h"
#include "bench/loading.h"

namespace knead::bench {

/// How long to measure.
struct SpeedRequest {
    std::uint32_t cells = 6;
    int steps = 6000;         ///< of the runtime; fewer when the time is up
    double budget_s = 20;     ///< for the timed steps of this size
    double accuracy_s = 0.2;  ///< length of each motion that is compared with exact steps
    int accuracy_motions = 2;
    double flops_per_s = 0;  ///< peak of this core
};

/// One row of the main table: one size of scenario 1 under the trembling press, with cold starts.
struct SpeedRow {
    std::uint32_t cells = 0;
    std::uint64_t tetrahedra = 0, nodes = 0;
    int timed_steps = 0, baseline_timed_steps = 0, cold_starts = 0;
    baseline::Percentiles us, baseline_us;
    double ratio = 0;  ///< of the medians
    double mean_iterations = 0;
    std::uint32_t largest_iterations = 0;
    double baseline_mean_iterations = 0;
    double force_error = 0, trajectory_error = 0, baseline_force_error = 0;
    int bad_status_steps = 0;
    bool repeatable = false;  ///< timed and compared runs of the same motion gave the same bits
    Bound bound;
    Loading loading;
    std::uint64_t preconditioner_bytes = 0;  ///< of the runtime, in its own words
    std::uint64_t allocations = 0;           ///< by all timed steps together
};

[[nodiscard]] SpeedRow measure_speed(const SpeedRequest& request);

}  // namespace knead::bench
