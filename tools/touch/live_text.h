// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "knead/haptics/run_statistics.h"
#include "touch/touch_meter.h"
#include "touch/touch_setup.h"

namespace knead::tools {

/// What stays the same while a run is on.
struct LiveFrame {
    std::string title;  ///< "scenario1 k3-1296, tool press, touch"
    double seconds = 0;
    double limit_n = 0;
    HapticMode mode = HapticMode::synchronous;
    double rate_hz = 1000, simulation_rate_hz = 120;
    bool virtual_time = false;
};

[[nodiscard]] LiveFrame live_frame(const Asset& asset, const TouchSetup& setup);

/// "[######------]": as many of `cells` as `share` says; ends with '!' instead of ']' when share is 1 or
/// more.
[[nodiscard]] std::string bar(double share, std::size_t cells);

/// The status block of a terminal: always the same number of lines, none longer than `columns`. ASCII.
[[nodiscard]] std::vector<std::string> live_block(const LiveFrame& frame, const TouchTotals& totals,
                                                  const RunStatistics& statistics, std::size_t columns);

/// The same in one line, for logs and pipes.
[[nodiscard]] std::string live_line(const LiveFrame& frame, const TouchTotals& totals,
                                    const RunStatistics& statistics);

}  // namespace knead::tools
