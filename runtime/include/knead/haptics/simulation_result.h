// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "knead/runtime/local_model.h"
#include "knead/runtime/step_result.h"

namespace knead {

/// What the simulation's side of a two-rate loop hands to the haptic side: one step and the local model at
/// its end. Plain data without pointers: it may be copied, stored and replayed.
struct SimulationResult {
    std::uint64_t number = 0;     ///< of this step since the loop was made, from 1; 0: no result
    std::uint64_t hand_tick = 0;  ///< number of the HapticTick whose pose the step went to; 0: none yet
    double dt_s = 0;              ///< of the step
    Pose hand;                    ///< what the step was given, scene frame
    StepResult step;              ///< force of the coupling on the hand, scene frame, at the end of the step
    LocalModel model;             ///< model.step is 0 when there is none: the step failed
};
static_assert(std::is_trivially_copyable_v<SimulationResult>);

}  // namespace knead
