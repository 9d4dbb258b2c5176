// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "knead/formats/asset.h"

namespace knead::tools {

/// Microseconds of one step, nearest rank.
struct StepTimes {
    double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0;
    int steps = 0;
    int not_ok = 0;  ///< steps whose status was not ok
};

/// Times single steps of 1 ms under a press with a hand's tremor (10 Hz, 0.3 mm along the press, a third of
/// it sideways), from rest again every 250 steps; the first 50 steps warm the caches and are not counted.
[[nodiscard]] StepTimes time_steps(const Asset& asset, std::size_t tool, const Point& direction, double way_m,
                                   int steps);

/// The runtime and the plain baseline (baseline/baseline.h) under the same press of the first tool.
struct SpeedPair {
    StepTimes runtime, baseline;
};

/// Both in turns, ten steps each, so that whatever else the machine does hits both.
/// @param asset its first tool bonded
[[nodiscard]] SpeedPair time_in_turns(const Asset& asset, const Point& direction, double way_m, int steps);

/// What the speed-up of a mesh is made of.
struct SpeedResult {
    std::string method;  ///< "reference": the raw elasticities
    std::uint32_t bins = 0, clusters = 0;
    std::uint64_t tetrahedra = 0;
    SpeedPair times;
};

}  // namespace knead::tools
