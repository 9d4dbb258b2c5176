// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "haptics/haptic_side.h"
#include "knead/haptics/simulation_result.h"
#include "knead/runtime/simulation.h"

namespace knead {

/// The simulation's side of a two-rate loop: the newest hand, one step, the local model at its end.
///
/// The step has a coupling of its own (simulation_config()) and follows the hand, not the haptic side's
/// proxy: a wrong forecast there cannot come back as a motion here. Used by one thread at a time; no
/// allocation, no lock.
class SimulationSide {
  public:
    SimulationSide(Simulation& simulation, Exchange& exchange) noexcept;
    SimulationResult simulate(double dt_s) noexcept;

  private:
    void bring_to_rest(SimulationResult& result) noexcept;

    Simulation* simulation_;
    Exchange* exchange_;
    HandSample sample_;
    std::uint64_t number_ = 0;
    Pose last_tool_;
    bool has_last_tool_ = false;
};

}  // namespace knead
