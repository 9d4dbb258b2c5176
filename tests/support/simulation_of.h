// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <utility>

#include "knead/runtime/simulation.h"

namespace knead::test {

/// @throws std::runtime_error when the runtime refuses the asset
inline Simulation simulation_of(const Asset& asset, const SimulationConfig& config = {}) {
    Result<Simulation> created = Simulation::create(asset, config);
    if (!created.ok()) throw std::runtime_error(created.error().text());
    return std::move(created).value();
}

}  // namespace knead::test
