// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/implicit_euler.h"

#include "reference/load_steps.h"
#include "reference/moving_body.h"
#include "reference/prescribed_unknowns.h"

namespace knead::tools {

struct ImplicitEuler::Impl {
    MovingBody body;
};

ImplicitEuler::ImplicitEuler(const TetMesh& mesh, const Material& material, const BodyForces& forces)
    : impl_(new Impl{{mesh, material, forces}}) {}
ImplicitEuler::ImplicitEuler(ImplicitEuler&&) noexcept = default;
ImplicitEuler& ImplicitEuler::operator=(ImplicitEuler&&) noexcept = default;
ImplicitEuler::~ImplicitEuler() = default;

MotionState ImplicitEuler::rest() const {
    return impl_->body.rest();
}

MotionStep ImplicitEuler::step(const MotionState& from, const PrescribedMotion& prescribed, double dt_s,
                               const NewtonLimits& limits) {
    MovingBody& body = impl_->body;
    const PosedStep step = body.step_from(from, dt_s);
    const PrescribedUnknowns unknowns = spread(prescribed, body.elastic().rest_positions_m());
    Eigen::VectorXd positions = step.start_m;
    MotionStep result;
    result.solution = equilibrium(step.objective, body.system_for(unknowns.is_prescribed), prescribed,
                                  unknowns.target_m, limits, positions);
    result.state = step.end(positions);
    return result;
}

}  // namespace knead::tools
