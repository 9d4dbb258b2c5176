// SPDX-License-Identifier: Apache-2.0
#include "haptics/simulation_side.h"

#include <Eigen/Core>

#include "haptics/twist.h"

namespace knead {

SimulationSide::SimulationSide(Simulation& simulation, Exchange& exchange) noexcept
    : simulation_(&simulation), exchange_(&exchange) {
    sample_.pose = simulation.tool_rest_pose();
}

SimulationResult SimulationSide::simulate(double dt_s) noexcept {
    (void)exchange_->hands.read(sample_);
    SimulationResult result;
    result.number = ++number_;
    result.hand_tick = sample_.tick;
    result.dt_s = dt_s;
    result.hand = sample_.pose;
    result.step = simulation_->step(sample_.pose, dt_s);
    if (simulation_->local_model(0, result.model))
        bring_to_rest(result);
    else
        has_last_tool_ = false;
    return result;
}

/// The load of the model's law belongs to a tool at rest; the object pushed a moving one. Left in, what is
/// pressed in fast seems thicker than it is (by a quarter at 30 mm/s in a cube of 110 kPa), and gives that
/// back to the hand.
void SimulationSide::bring_to_rest(SimulationResult& result) noexcept {
    LocalModel& model = result.model;
    if (has_last_tool_ && model.touched_nodes > 0) {
        const Vec6 velocity = twist(last_tool_, model.origin) / result.dt_s;
        const Vec6 damped =
            Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(model.damping.data()) * velocity;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            model.force_n[axis] += damped[static_cast<int>(axis)];
            model.torque_nm[axis] += damped[static_cast<int>(axis) + 3];
        }
    }
    last_tool_ = model.origin;
    has_last_tool_ = true;
}

}  // namespace knead
