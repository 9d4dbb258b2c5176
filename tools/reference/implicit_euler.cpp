// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/implicit_euler.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "common/error.h"
#include "reference/load_steps.h"
#include "reference/prescribed_unknowns.h"

namespace knead::tools {

struct ImplicitEuler::Impl {
    ElasticBody body;
    Eigen::VectorXd mass_kg;  // [3 nodes]
    Eigen::VectorXd gravity_m_per_s2;
    double damping_per_s;
    std::optional<FreeSystem> system;  // of the last set of prescribed unknowns

    /// The step as a minimisation: all terms but the elastic one are springs to where they alone would lead.
    [[nodiscard]] Objective objective(const Eigen::VectorXd& x0, const Eigen::VectorXd& v0,
                                      double dt_s) const {
        const double rate = 1 / (dt_s * dt_s) + damping_per_s / dt_s;
        Objective result;
        result.body = &body;
        result.weight_n_per_m = mass_kg * rate;
        result.anchor_m = x0 + (v0 / dt_s + gravity_m_per_s2) / rate;
        return result;
    }
};

namespace {

Eigen::VectorXd per_axis(const Eigen::VectorXd& per_node) {
    Eigen::VectorXd result(3 * per_node.size());
    for (Eigen::Index k = 0; k < result.size(); ++k)
        result[k] = per_node[k / 3];
    return result;
}

}  // namespace

ImplicitEuler::ImplicitEuler(const TetMesh& mesh, const Material& material, const BodyForces& forces)
    : impl_(std::make_unique<Impl>(Impl{ElasticBody(mesh, material), {}, {}, forces.damping_per_s, {}})) {
    if (!std::isfinite(forces.damping_per_s) || forces.damping_per_s < 0)
        fail_input(fmt::format("damping is {} per second, not finite and >= 0", forces.damping_per_s));
    impl_->mass_kg = per_axis(impl_->body.lumped_mass_kg());
    const std::size_t nodes = impl_->body.node_count();
    impl_->gravity_m_per_s2 =
        to_unknowns(std::vector<Point>(nodes, forces.gravity_m_per_s2), nodes, "gravity");
}

ImplicitEuler::ImplicitEuler(ImplicitEuler&&) noexcept = default;
ImplicitEuler& ImplicitEuler::operator=(ImplicitEuler&&) noexcept = default;
ImplicitEuler::~ImplicitEuler() = default;

MotionState ImplicitEuler::rest() const {
    return {to_points(impl_->body.rest_positions_m()),
            std::vector<Point>(impl_->body.node_count(), Point{0, 0, 0})};
}

MotionStep ImplicitEuler::step(const MotionState& from, const PrescribedMotion& prescribed, double dt_s,
                               const NewtonLimits& limits) {
    if (!std::isfinite(dt_s) || dt_s <= 0)
        fail_input(fmt::format("time step is {} s, not finite and > 0", dt_s));
    const ElasticBody& body = impl_->body;
    const PrescribedUnknowns unknowns = spread(prescribed, body.rest_positions_m());
    const Eigen::VectorXd x0 = to_unknowns(from.positions_m, body.node_count(), "positions");
    const Eigen::VectorXd v0 = to_unknowns(from.velocities_m_per_s, body.node_count(), "velocities");
    if (!impl_->system || impl_->system->is_prescribed() != unknowns.is_prescribed)
        impl_->system.emplace(body, unknowns.is_prescribed);
    const Objective objective = impl_->objective(x0, v0, dt_s);

    Eigen::VectorXd positions = x0;
    MotionStep result;
    result.solution =
        equilibrium(objective, *impl_->system, prescribed, unknowns.target_m, limits, positions);
    result.state.positions_m = to_points(positions);
    result.state.velocities_m_per_s = to_points((positions - x0) / dt_s);
    return result;
}

}  // namespace knead::tools
