// SPDX-License-Identifier: Apache-2.0
#include "core/step.h"

#include <algorithm>
#include <cmath>

namespace knead::core {
namespace {

/// A caller's dt that is computed as 1 / rate may miss the ends of the range by rounding.
constexpr double kStepSlack = 1e-9;
/// How far the norm of a unit quaternion may be from one.
constexpr double kUnitTolerance = 1e-3;
/// Root mean square of the velocity error that never is exceeded, whatever the force tolerance
/// (runtime.md 3.3).
constexpr double kVelocityTolerance_m_per_s = 1e-4;

bool valid_step(double dt_s) {
    return dt_s >= kSmallestStep_s * (1 - kStepSlack) && dt_s <= kLargestStep_s * (1 + kStepSlack);
}

bool to_frame(const Pose& pose, Frame& frame) {
    const auto& p = pose.position_m;
    const auto& o = pose.orientation_wxyz;
    const Quat q(o[0], o[1], o[2], o[3]);
    const double norm = q.norm();
    if (!(std::abs(norm - 1) <= kUnitTolerance)) return false;
    frame.position = Vec(p[0], p[1], p[2]);
    frame.rotation = q.normalized().toRotationMatrix();
    return frame.position.allFinite();
}

Vec3 to_array(const Vec& v) {
    return {v.x(), v.y(), v.z()};
}

}  // namespace

Stepper::Stepper(const Asset& asset, const SimulationConfig& config)
    : config_(config),
      model_(build_model(asset)),
      pass_(model_),
      contact_(asset.tools[config.tool], model_),
      preconditioner_(model_),
      solver_(model_, contact_.max_constraints()) {
    const std::size_t nodes = model_.rest_m.size();
    positions_.resize(nodes);
    velocities_.resize(nodes);
    predicted_.resize(nodes);
    load_.resize(nodes);
    solution_.displacement.nodes.resize(nodes);
    solution_.reaction_n.assign(contact_.max_constraints(), Vec::Zero());
    reset();
}

void Stepper::reset() noexcept {
    positions_ = model_.rest_m;
    std::fill(velocities_.begin(), velocities_.end(), Vec::Zero());
    tool_position_ = hand_position_ = contact_.rest_frame().position;
    tool_velocity_.setZero();
    pass_.reset();
    contact_.reset();
}

StepResult Stepper::step(const Pose& pose, double dt_s) noexcept {
    Frame hand;
    if (!valid_step(dt_s) || !to_frame(pose, hand)) return refuse(kStepBadInput);
    const Real dt = dt_s;

    // 1. Predict where inertia carries everything, and linearise there.
    predict(hand, dt);
    // 2. One pass over the tetrahedra: rotations, forces, right-hand side.
    linearise(dt);
    // 3. Conjugate gradients, again for as long as the set of touched nodes changes.
    const std::uint32_t status = solve_with_contact(dt);
    if (!finite()) {
        contact_.abandon_step();
        return refuse(status | kStepNotFinite);
    }
    // 4. The reaction stands in the rows of the held nodes; take over the new state.
    return accept(hand, dt, status);
}

void Stepper::predict(const Frame& hand, Real dt) noexcept {
    for (std::uint32_t i = 0; i < model_.free_count; ++i)
        predicted_[i] = positions_[i] + dt * velocities_[i];
    std::copy(positions_.begin() + model_.free_count, positions_.end(),
              predicted_.begin() + model_.free_count);
    tool_ = hand;
    coupling_ = {};
    if (!coupled()) return;
    const Real stiffness = config_.coupling_stiffness_n_per_m;
    const Real damping = config_.coupling_damping_n_s_per_m;
    tool_.position = tool_position_ + dt * tool_velocity_;
    const Vec hand_velocity = (hand.position - hand_position_) / dt;
    coupling_.moves = true;
    coupling_.mass_kg = config_.tool_mass_kg;
    coupling_.rate_n_per_m = stiffness + damping / dt;
    coupling_.force_n =
        stiffness * (tool_.position - hand.position) + damping * (tool_velocity_ - hand_velocity);
}

void Stepper::linearise(Real dt) noexcept {
    pass_.linearise(model_, predicted_, load_);
    const Real dt2 = dt * dt;
    const bool heavy = !model_.gravity_m_per_s2.isZero(0);
    for (std::uint32_t i = 0; i < model_.free_count; ++i) {
        if (heavy) load_[i] += model_.mass_kg[i] * model_.gravity_m_per_s2;
        if (model_.damping_per_s > 0) load_[i] -= (model_.damping_per_s * model_.mass_kg[i]) * velocities_[i];
        load_[i] *= dt2;
    }
}

std::uint32_t Stepper::solve_with_contact(Real dt) noexcept {
    const System system{model_, pass_, contact_.constraints(), coupling_, dt, 1 + model_.damping_per_s * dt};
    const SolverLimits limits{config_.max_solver_iterations, config_.force_tolerance,
                              std::min<Real>(kVelocityTolerance_m_per_s, config_.force_tolerance)};
    std::fill(solution_.displacement.nodes.begin(), solution_.displacement.nodes.end(), Vec::Zero());
    solution_.displacement.tool.setZero();
    iterations_ = 0;

    contact_.begin_step(tool_, predicted_);
    preconditioner_.refresh(system);
    for (int pass = 0; pass < config_.max_contact_passes; ++pass) {
        preconditioner_.hold(system);
        solver_.solve(system, preconditioner_, load_, limits, solution_);
        iterations_ += static_cast<std::uint32_t>(solution_.iterations);
        if (!solution_.converged) return kStepNotConverged;
        const Real touched = static_cast<Real>(std::max<std::size_t>(1, contact_.constraints().size()));
        const Real pull_tolerance = limits.force_tolerance * solution_.force_n.norm() / touched;
        if (!contact_.revise(tool_, predicted_, solution_, pull_tolerance)) return kStepOk;
    }
    return kStepContactCap;
}

bool Stepper::finite() const noexcept {
    // A sum is finite only if every term is. Divided by the smallest step, it covers the velocities too.
    Vec sum = solution_.force_n + solution_.displacement.tool + tool_.position;
    for (std::uint32_t i = 0; i < model_.free_count; ++i)
        sum += predicted_[i] + solution_.displacement.nodes[i];
    return (sum / Real(kSmallestStep_s)).allFinite();
}

StepResult Stepper::accept(const Frame& hand, Real dt, std::uint32_t status) noexcept {
    const bool failed = (status & kStepNotConverged) != 0;
    for (std::uint32_t i = 0; i < model_.free_count; ++i) {
        const Vec next = predicted_[i] + solution_.displacement.nodes[i];
        velocities_[i] = (next - positions_[i]) / dt;
        // An unsolved velocity would enter the next prediction and grow.
        if (failed) velocities_[i].setZero();
        positions_[i] = next;
    }
    tool_.position += solution_.displacement.tool;
    tool_velocity_ = (tool_.position - tool_position_) / dt;
    tool_position_ = tool_.position;
    hand_position_ = hand.position;
    contact_.end_step(tool_, positions_);

    StepResult result;
    result.force_n = to_array(solution_.force_n);
    result.status = status;
    result.solver_iterations = iterations_;
    result.touched_nodes = static_cast<std::uint32_t>(contact_.constraints().size());
    result.tool_position_m = to_array(tool_position_);
    return result;
}

StepResult Stepper::refuse(std::uint32_t status) const noexcept {
    StepResult result;
    result.status = status;
    result.tool_position_m = to_array(tool_position_);
    return result;
}

}  // namespace knead::core
