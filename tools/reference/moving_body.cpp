// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/moving_body.h"

#include <fmt/format.h>

#include <cmath>

#include "common/error.h"
#include "reference/prescribed_unknowns.h"

namespace knead::tools {

MotionState PosedStep::end(const Eigen::VectorXd& positions_m) const {
    return {to_points(positions_m), to_points((positions_m - start_m) / dt_s)};
}

MovingBody::MovingBody(const TetMesh& mesh, const Material& material, const BodyForces& forces)
    : elastic_(mesh, material), damping_per_s_(forces.damping_per_s) {
    if (!std::isfinite(damping_per_s_) || damping_per_s_ < 0)
        fail_input(fmt::format("damping is {} per second, not finite and >= 0", damping_per_s_));
    mass_kg_ = elastic_.lumped_mass_kg().transpose().replicate(3, 1).reshaped();
    const std::size_t nodes = elastic_.node_count();
    gravity_m_per_s2_ = to_unknowns(std::vector<Point>(nodes, forces.gravity_m_per_s2), nodes, "gravity");
}

MotionState MovingBody::rest() const {
    return {to_points(elastic_.rest_positions_m()),
            std::vector<Point>(elastic_.node_count(), Point{0, 0, 0})};
}

Eigen::VectorXd MovingBody::weight_n() const {
    if (gravity_m_per_s2_.isZero(0)) return {};
    return mass_kg_.cwiseProduct(gravity_m_per_s2_);
}

PosedStep MovingBody::step_from(const MotionState& from, double dt_s) const {
    if (!std::isfinite(dt_s) || dt_s <= 0)
        fail_input(fmt::format("time step is {} s, not finite and > 0", dt_s));
    PosedStep step;
    step.dt_s = dt_s;
    step.start_m = to_unknowns(from.positions_m, elastic_.node_count(), "positions");
    step.start_m_per_s = to_unknowns(from.velocities_m_per_s, elastic_.node_count(), "velocities");
    const double rate = 1 / (dt_s * dt_s) + damping_per_s_ / dt_s;
    step.objective.body = &elastic_;
    step.objective.weight_n_per_m = mass_kg_ * rate;
    step.objective.anchor_m = step.start_m + (step.start_m_per_s / dt_s + gravity_m_per_s2_) / rate;
    return step;
}

}  // namespace knead::tools
