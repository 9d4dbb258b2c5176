// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "baseline/statistics.h"

namespace knead::bench {

/// What the haptic part of a cycle costs: device, map, rendering, safety; without the simulation's step.
struct HapticCycleRow {
    std::string rendering;  ///< "reduced object", "reduced object, 6 dof", "linear", "hold"
    int ticks = 0;
    baseline::Percentiles us;  ///< of one tick
};

/// A plate on a cube of cells^3, two-rate in virtual time at 1 kHz, the simulation at 120 Hz between the
/// timed ticks; a hand that moves in and out of the object.
[[nodiscard]] std::vector<HapticCycleRow> measure_haptic_cycle(std::uint32_t cells, int ticks);

}  // namespace knead::bench
