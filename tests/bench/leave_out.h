// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "baseline/statistics.h"

namespace knead::bench {

/// What one thing that a scene may ask for costs.
struct LeaveOutRow {
    std::string scene;  ///< "minimal", "+ gravity", ...
    std::uint64_t file_bytes = 0;
    std::int64_t simulation_bytes = 0;
    baseline::Percentiles us;
};

/// The minimal press first, then with one thing more each, then with all that go together; timed in turns.
[[nodiscard]] std::vector<LeaveOutRow> measure_leave_out(std::uint32_t cells, int steps);

}  // namespace knead::bench
