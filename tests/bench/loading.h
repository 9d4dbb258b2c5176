// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "knead/formats/asset.h"
#include "knead/runtime/simulation.h"

namespace knead::bench {

/// An asset's way from disk to a simulation that is ready to step.
struct Loading {
    double first_ms = 0;   ///< the first of the process: libraries, caches and pages still cold
    double median_ms = 0;  ///< of the later ones
    std::uint64_t file_bytes = 0;
    std::int64_t simulation_bytes = 0;  ///< that a loaded simulation keeps allocated
};

/// Writes the asset to a temporary file, loads it several times, removes it.
/// @throws std::runtime_error when that is refused
[[nodiscard]] Loading measure_loading(const Asset& asset, int repetitions,
                                      const SimulationConfig& config = {});

/// @throws std::runtime_error when the runtime refuses the asset
[[nodiscard]] Simulation make_simulation(const Asset& asset, const SimulationConfig& config = {});

}  // namespace knead::bench
