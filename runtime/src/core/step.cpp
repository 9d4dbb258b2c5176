// SPDX-License-Identifier: Apache-2.0
#include "core/step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/denormals.h"
#include "core/loose_parts.h"
#include "core/typed_stepper.h"

namespace knead::core {
namespace {

/// A caller's dt that is computed as 1 / rate may miss the ends of the range by rounding.
constexpr double kStepSlack = 1e-9;
/// How far the norm of a unit quaternion may be from one.
constexpr double kUnitTolerance = 1e-3;
/// How far a tool may carry the nodes bonded to it, in sizes of the object. Beyond, displacements in float32
/// have no room left for the object's shape.
constexpr Real kFarthestCarried = 1e4;
/// Root mean square of the velocity error that a step may make: in an object without great contrasts, and in
/// one where soft matter between stiff would drift unseen by the force.
constexpr double kVelocityTolerance_m_per_s = 3e-4;
constexpr double kHardVelocityTolerance_m_per_s = 1e-4;
/// Root mean square of the last correction, in mean edges, up to which the next step is predicted with it.
/// Beyond that motion is abrupt, and a wrong prediction would be a bad point to linearise at.
constexpr Real kSmallCorrection = 5e-4;
/// Factor between this dt and the last one up to which a step is predicted with the last correction. It
/// counts by its square: 0.25 and 20 ms in turn made it 6,400 times too large, and the motion grew.
constexpr Real kSteadyDt = 2;
/// Friction may miss Coulomb's law by this many times the relative force tolerance: it is only a part of the
/// force, and each of its updates costs a solve.
constexpr double kConePerForceTolerance = 10;
/// Iterations of a solve after which its touched nodes are looked at: later ones hardly change them.
constexpr int kMostLooks = 2;
/// A pull that is seen there must be this many times that of a solve that has ended.
constexpr Real kPullSeenEarly = 10;
/// Where a preconditioned residual is a fair measure of the error.
constexpr double kTrustedContrast = 1e3;
constexpr double kTrustedPoissonsRatio = 0.45;
/// What is asked of the force for which a solve in single precision on a state in double is still chosen: its
/// rounding is about that in the hardest matter that numerics.h gives it (docs/simulation.md).
constexpr double kMixedForceTolerance = 1e-4;

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

template <class S, class V>
bool TypedStepper<S, V>::EarlyLook::stops(const Solution<V>& /*solution*/) noexcept {
    if (limits_.belief == Belief::never || ++looks_ > kMostLooks) return false;
    return stepper_.contact_.glance(stepper_.attempt(limits_, true));
}

template <class S, class V>
TypedStepper<S, V>::TypedStepper(const Asset& asset, const SimulationConfig& config, const Numerics& numerics,
                                 SimdTarget target)
    : config_(config),
      kernels_(kernels(target)),
      fields_(kernels_.field<S>()),
      solve_fields_(kernels_.field<V>()),
      model_(build_model(asset, config.tools)),
      masses_(model_),
      elements_(model_, kernels_),
      contact_(renumbered(asset, config.tools, model_), model_, BondedNodes::left_out),
      preconditioner_(model_, elements_, numerics, target, config.expected_dt_s,
                      touchable(asset, config.tools, model_)),
      solver_(model_, config.tools.size(), contact_.max_constraints()),
      trusts_preconditioner_(numerics.contrast <= kTrustedContrast &&
                             numerics.max_poissons_ratio <= kTrustedPoissonsRatio),
      unilateral_(std::any_of(config.tools.begin(), config.tools.end(),
                              [&](std::size_t k) { return asset.tools[k].contact != ToolContact::bonded; })),
      linearisations_(model_, numerics, config.max_linearisations),
      for_solve_(model_.rest_m.size()),
      from_solve_(model_.rest_m.size()) {
    const std::size_t nodes = model_.rest_m.size(), count = config.tools.size();
    for (NodeField<S>* field :
         {&displacements_, &velocities_, &beyond_, &owed_, &predicted_, &load_, &scratch_, &ahead_}) {
        *field = NodeField<S>(nodes);
    }
    solution_.displacement.nodes = NodeField<V>(nodes);
    tools_.resize(count);
    hands_.resize(count);
    frames_.resize(count);
    unknowns_.resize(count);
    results_.resize(count);
    solution_.displacement.tools.assign(count, Vec::Zero());
    solution_.force_n.assign(count, Vec::Zero());
    solution_.row_n.assign(contact_.max_constraints(), Vec::Zero());
    for (std::size_t k = 0; k < count; ++k) {
        const Model::Range bonded = model_.bonded[k];
        SteppedTool& tool = tools_[k];
        for (std::uint32_t i = bonded.begin; i < bonded.end; ++i)
            tool.anchors.push_back(contact_.rest_frame(k).to_local(model_.rest_m[i]));
        tool.displacements_m = tool.velocities = tool.next_m = tool.accelerations = tool.anchors;
    }
    if (config.with_local_model) make_room_for_views(renumbered(asset, config.tools, model_));
    reset();
}

template <class S, class V>
void TypedStepper<S, V>::make_room_for_views(const std::vector<ToolSet>& tools) {
    std::size_t most = contact_.max_constraints();
    for (std::size_t k = 0; k < tools.size(); ++k) {
        reaches_.emplace_back(tools[k], model_.mean_edge_m);
        most += tools_[k].anchors.size();
    }
    held_.reserve(most);
    impedance_.emplace(model_, tools.size(), config_.with_torque ? 6 : 3);
}

template <class S, class V>
void TypedStepper<S, V>::reset() noexcept {
    step_dt_s_ = 0;
    steps_ = 0;
    if (impedance_) impedance_->reset();
    displacements_.fill_zero();
    velocities_.fill_zero();
    beyond_.fill_zero();
    smoothness_ = 0;
    owed_.fill_zero();
    elements_.reset();
    contact_.reset();
    preconditioner_.reset();
    solver_.reset();
    for (std::size_t k = 0; k < tools_.size(); ++k) {
        SteppedTool& tool = tools_[k];
        tool.position = tool.hand = contact_.rest_frame(k).position;
        tool.velocity.setZero();
        std::fill(tool.displacements_m.begin(), tool.displacements_m.end(), Vec::Zero());
        std::fill(tool.velocities.begin(), tool.velocities.end(), Vec::Zero());
        results_[k] = {};
        results_[k].tool_position_m = to_array(tool.position);
    }
}

template <class S, class V>
StepResult TypedStepper<S, V>::step(const Pose* poses, double dt_s) noexcept {
    const NoDenormals no_denormals;
    if (!valid_step(dt_s)) return refuse(kStepBadInput);
    for (std::size_t k = 0; k < hands_.size(); ++k) {
        if (!to_frame(poses[k], hands_[k]) || carries_too_far(k)) return refuse(kStepBadInput);
    }
    const System<V> system = this->system(dt_s);
    iterations_ = 0;

    // 1. Predict where inertia carries everything.
    predict(hands_.data(), dt_s);
    // 2. One pass over the tetrahedra there: rotations, forces, right-hand side.
    linearise(system);
    // 3. Conjugate gradients, again for as long as the set of touched nodes changes.
    std::uint32_t status = solve_with_contact(system);
    // 4. Where matter asks for it, 2 and 3 again where the solution came.
    Real way_m = std::numeric_limits<Real>::infinity();
    for (int more = linearisations_.most(dt_s) - 1; more > 0 && status == kStepOk && went_far(); --more) {
        way_m = cut_overshoot(way_m);
        predict_again(system);
        linearise(system);
        status = solve_with_contact(system);
    }
    if (!finite()) {
        contact_.abandon_step();
        return refuse(status | kStepNotFinite);
    }
    // 5. The reaction stands in the rows of the held nodes; take over the new state.
    accept(hands_.data(), dt_s, (status & kStepNotConverged) != 0);
    find_results(dt_s);
    step_dt_s_ = dt_s;
    ++steps_;
    return result(status | (inside_out_ ? kStepInsideOut : kStepOk));
}

template <class S, class V>
System<V> TypedStepper<S, V>::system(Real dt) noexcept {
    return {model_,
            elements_,
            masses_,
            solve_fields_,
            contact_.constraints(),
            unknowns_,
            dt,
            1 + model_.damping_per_s * dt};
}

template <class S, class V>
bool TypedStepper<S, V>::carries_too_far(std::size_t k) const noexcept {
    const Real way_m = (hands_[k].position - contact_.rest_frame(k).position).norm();
    return !tools_[k].anchors.empty() && way_m > kFarthestCarried * model_.size_m;
}

template <class S, class V>
void TypedStepper<S, V>::predict(const Frame* hands, Real dt) noexcept {
    const std::size_t free = run_of(model_.free_count);
    const Real dt_ratio = dt / beyond_dt_s_;
    const bool steady = dt_ratio <= kSteadyDt && dt_ratio >= 1 / kSteadyDt;
    ahead_share_ = steady ? smoothness_ * dt_ratio * dt_ratio : 0;
    again_ = false;
    fields_.add_scaled(free, displacements_.data(), static_cast<S>(dt), velocities_.data(),
                       predicted_.data());
    fields_.add_scaled(free, predicted_.data(), static_cast<S>(ahead_share_), beyond_.data(),
                       predicted_.data());
    for (std::size_t k = 0; k < tools_.size(); ++k) {
        unknowns_[k] = {};
        tools_[k].frame = hands[k];
        if (coupled()) couple(tools_[k], unknowns_[k], hands[k], dt);
        frames_[k] = tools_[k].frame;
        predict_bonded(k);
    }
    contact_.begin_step(frames_, NodeReader(model_.rest_m, predicted_), dt);
}

template <class S, class V>
void TypedStepper<S, V>::couple(SteppedTool& tool, ToolUnknown& unknown, const Frame& hand,
                                Real dt) const noexcept {
    const Real stiffness = config_.coupling_stiffness_n_per_m;
    const Real damping = config_.coupling_damping_n_s_per_m;
    tool.frame.position = tool.position + dt * tool.velocity;
    const Vec hand_velocity = (hand.position - tool.hand) / dt;
    unknown.moves = true;
    unknown.mass_kg = config_.tool_mass_kg;
    unknown.rate_n_per_m = stiffness + damping / dt;
    unknown.force_n =
        stiffness * (tool.frame.position - hand.position) + damping * (tool.velocity - hand_velocity);
}

/// Bonded nodes go where their tool takes them: a better point to linearise at than along their velocity.
template <class S, class V>
void TypedStepper<S, V>::predict_bonded(std::size_t k) noexcept {
    SteppedTool& tool = tools_[k];
    const std::uint32_t begin = model_.bonded[k].begin;
    for (std::size_t i = 0; i < tool.anchors.size(); ++i) {
        const std::size_t node = begin + i;
        tool.next_m[i] = tool.frame.to_scene(tool.anchors[i]) - model_.rest_m[node];
        predicted_.set(node, tool.next_m[i]);
    }
}

/// The right-hand side dt^2 (elastic force + gravity - damping) at the prediction, in kg m. Bonded nodes also
/// carry what accelerates them: their rows are the tool's reaction.
template <class S, class V>
void TypedStepper<S, V>::linearise(const System<V>& system) noexcept {
    const Real dt = system.dt_s, dt2 = dt * dt;
    inside_out_ = elements_.linearise(static_cast<S>(dt2), predicted_, load_);
    const std::size_t free = run_of(model_.free_count);
    fields_.add_scaled(free, load_.data(), static_cast<S>(dt / owed_dt_s_), owed_.data(), load_.data());
    fields_.multiply(free, from_solve_.of(masses_.kg).data(), static_cast<S>(-system.inertia * ahead_share_),
                     ahead().data(), scratch_.data());
    fields_.add_scaled(free, load_.data(), S(1), scratch_.data(), load_.data());
    const Vec& gravity = model_.gravity_m_per_s2;
    if (!gravity.isZero(0)) {
        for (std::uint32_t i = 0; i < model_.moving_count; ++i)
            load_.add(i, (dt2 * model_.mass_kg[i]) * gravity);
    }
    if (model_.damping_per_s > 0) {
        for (std::uint32_t i = 0; i < model_.free_count; ++i)
            load_.add(i, (-dt2 * model_.damping_per_s * model_.mass_kg[i]) * velocities_.get(i));
    }
    for (std::size_t k = 0; k < tools_.size(); ++k) {
        const SteppedTool& tool = tools_[k];
        for (std::size_t i = 0; i < tool.anchors.size(); ++i) {
            const std::size_t node = model_.bonded[k].begin + i;
            const Vec along = dt * tool.velocities[i];
            const Vec moved = tool.next_m[i] - tool.displacements_m[i];
            const Vec damped = (model_.damping_per_s * dt) * moved;
            load_.add(node, -model_.mass_kg[node] * (moved - along + damped));
        }
    }
}

/// How far the solution is from where it was linearised: root mean square over the free nodes.
template <class S, class V>
Real TypedStepper<S, V>::way_of_solution_m() const noexcept {
    const NodeField<V>& d = solution_.displacement.nodes;
    const Real squared = static_cast<Real>(solve_fields_.dot(run_of(model_.free_count), d.data(), d.data()));
    return std::sqrt(squared / std::max(1U, model_.free_count));
}

/// Whether that is so far that it may be worth another linearisation.
template <class S, class V>
bool TypedStepper<S, V>::went_far() const noexcept {
    return way_of_solution_m() > kNearlyLinear * model_.mean_edge_m;
}

/// Ways become shorter as Newton's method converges. Where stiff islands turn one another, one that is longer
/// than the last overshoots: it is cut to half of the last, and the next linearisation goes on from there.
/// (Flat tetrahedra need the whole way.)
/// @return the way that is left
template <class S, class V>
Real TypedStepper<S, V>::cut_overshoot(Real last_m) noexcept {
    const Real way_m = way_of_solution_m();
    if (way_m <= last_m || !linearisations_.overshoot()) return way_m;
    const Real share = last_m / (2 * way_m);
    NodeField<V>& d = solution_.displacement.nodes;
    solve_fields_.scale(run_of(model_.free_count), static_cast<V>(share), d.data());
    for (Vec& tool : solution_.displacement.tools)
        tool *= share;
    return share * way_m;
}

/// The solution becomes the prediction.
template <class S, class V>
void TypedStepper<S, V>::predict_again(const System<V>& system) noexcept {
    const std::size_t free = run_of(model_.free_count);
    const NodeField<S>& d = from_solve_.of(solution_.displacement.nodes);
    fields_.add_scaled(free, d.data(), static_cast<S>(ahead_share_), ahead().data(), ahead_.data());
    again_ = true;
    ahead_share_ = 1;
    fields_.add_scaled(free, predicted_.data(), S(1), d.data(), predicted_.data());
    for (std::size_t k = 0; k < tools_.size(); ++k) {
        SteppedTool& tool = tools_[k];
        ToolUnknown& unknown = unknowns_[k];
        const Vec further = solution_.displacement.tools[k];
        tool.frame.position += further;
        frames_[k] = tool.frame;
        unknown.force_n += unknown.rate_n_per_m * further;
        unknown.inertia_n += (unknown.mass_kg / (system.dt_s * system.dt_s)) * further;
        for (std::size_t i = 0; i < tool.anchors.size(); ++i) {
            tool.next_m[i] += further;
            predicted_.set(model_.bonded[k].begin + i, tool.next_m[i]);
        }
    }
    contact_.predict_again(frames_, NodeReader(model_.rest_m, predicted_));
    solver_.reset();
}

template <class S, class V>
std::uint32_t TypedStepper<S, V>::solve_with_contact(const System<V>& system) noexcept {
    const bool close = preconditioner_.is_close(system.dt_s);
    const bool trusts = close && trusts_preconditioner_;
    const Real drift = trusts ? kVelocityTolerance_m_per_s : kHardVelocityTolerance_m_per_s;
    const SolverLimits limits{config_.max_solver_iterations, config_.force_tolerance,
                              std::min<Real>(drift, config_.force_tolerance),
                              !close   ? Belief::never
                              : trusts ? Belief::from_the_start
                                       : Belief::after_watching};
    solution_.displacement.nodes.fill_zero();
    solution_.from_zero = true;
    std::fill(solution_.displacement.tools.begin(), solution_.displacement.tools.end(), Vec::Zero());
    if (again_)
        preconditioner_.turn(system);
    else
        preconditioner_.begin_step(system);
    const NodeField<V>& load = for_solve_.of(load_);
    EarlyLook look(*this, limits);
    for (int pass = 0; pass < config_.max_contact_passes;) {
        preconditioner_.hold(system);
        look.begin();
        solver_.solve(system, preconditioner_, load, limits, solution_, unilateral_ ? &look : nullptr);
        iterations_ += static_cast<std::uint32_t>(solution_.iterations);
        if (solution_.stopped) continue;
        ++pass;
        std::uint32_t status = kStepOk;
        if (settled(limits, status)) return status;
    }
    return kStepContactCap;
}

/// The solution of now, for the contact to judge.
template <class S, class V>
Attempt TypedStepper<S, V>::attempt(const SolverLimits& limits, bool early) const noexcept {
    Real force = 0;
    for (const Vec& f : solution_.force_n)
        force = std::max(force, f.norm());
    const Real touched = static_cast<Real>(std::max<std::size_t>(1, contact_.constraints().size()));
    return {NodeReader(model_.rest_m, predicted_),
            NodeReader(model_.rest_m, predicted_, solution_.displacement.nodes),
            solution_.displacement.tools,
            solution_.row_n,
            travel_m(),
            (early ? kPullSeenEarly : 1) * limits.force_tolerance * force / touched,
            kConePerForceTolerance * limits.force_tolerance,
            early};
}

/// Whether the step ends with this solve, and how.
template <class S, class V>
bool TypedStepper<S, V>::settled(const SolverLimits& limits, std::uint32_t& status) noexcept {
    if (!solution_.converged) status = kStepNotConverged;
    if (!unilateral_) return true;
    if (!solution_.converged) {
        contact_.measure(attempt(limits, false));
        return true;
    }
    const Contact::Revision revision = contact_.revise(attempt(limits, false));
    if (revision == Contact::Revision::given_up) status = kStepContactCap;
    return revision != Contact::Revision::changed;
}

/// The farthest that a free node has come since the step before.
template <class S, class V>
Real TypedStepper<S, V>::travel_m() const noexcept {
    Real squared = 0;
    for (std::uint32_t i = 0; i < model_.free_count; ++i) {
        const Vec moved = predicted_.get(i) + solution_.displacement.nodes.get(i) - displacements_.get(i);
        squared = std::max(squared, moved.squaredNorm());
    }
    return std::sqrt(squared);
}

template <class S, class V>
bool TypedStepper<S, V>::finite() const noexcept {
    // A sum of squares is finite only if every term is. Divided by the smallest step, it covers the
    // velocities.
    const std::size_t free = run_of(model_.free_count);
    const NodeField<V>& d = solution_.displacement.nodes;
    Real sum = static_cast<Real>(fields_.dot(free, predicted_.data(), predicted_.data())) +
               static_cast<Real>(solve_fields_.dot(free, d.data(), d.data()));
    for (std::size_t k = 0; k < tools_.size(); ++k) {
        sum += solution_.force_n[k].squaredNorm() + solution_.displacement.tools[k].squaredNorm() +
               tools_[k].frame.position.squaredNorm();
    }
    return std::isfinite(sum / (kSmallestStep_s * kSmallestStep_s));
}

template <class S, class V>
void TypedStepper<S, V>::accept(const Frame* hands, Real dt, bool failed) noexcept {
    const Real travel = unilateral_ ? travel_m() : 0;
    const std::size_t free = run_of(model_.free_count);
    const NodeField<S>& d = from_solve_.of(solution_.displacement.nodes);
    go_beyond(d, dt);
    fields_.add_scaled(free, velocities_.data(), static_cast<S>(1 / dt), beyond_.data(), velocities_.data());
    fields_.add_scaled(free, predicted_.data(), S(1), d.data(), displacements_.data());
    owe(dt);
    // An unsolved velocity would enter the next prediction and grow.
    if (failed) {
        velocities_.fill_zero();
        owed_.fill_zero();
        beyond_.fill_zero();
    }
    for (const LoosePart& part : model_.loose_parts) {
        if (!failed && !is_touched(part, contact_.constraints()))
            give_spin(part, model_, dt, displacements_, velocities_, beyond_);
    }
    for (std::size_t k = 0; k < tools_.size(); ++k) {
        SteppedTool& tool = tools_[k];
        const Vec further = solution_.displacement.tools[k];
        tool.frame.position += further;
        tool.velocity = (tool.frame.position - tool.position) / dt;
        tool.position = tool.frame.position;
        tool.hand = hands[k].position;
        frames_[k] = tool.frame;
        for (std::size_t i = 0; i < tool.anchors.size(); ++i) {
            const Vec next = tool.next_m[i] + further;
            const Vec velocity = (next - tool.displacements_m[i]) / dt;
            tool.accelerations[i] = (velocity - tool.velocities[i]) / dt;
            tool.velocities[i] = velocity;
            tool.displacements_m[i] = next;
            displacements_.set(model_.bonded[k].begin + i, next);
        }
    }
    contact_.end_step(frames_, NodeReader(model_.rest_m, displacements_), travel);
}

template <class S, class V>
void TypedStepper<S, V>::go_beyond(const NodeField<S>& d, Real dt) noexcept {
    const std::size_t free = run_of(model_.free_count);
    fields_.add_scaled(free, d.data(), static_cast<S>(ahead_share_), ahead().data(), scratch_.data());
    const Real ratio = (dt / beyond_dt_s_) * (dt / beyond_dt_s_);
    const Real expected = ratio * static_cast<Real>(fields_.dot(free, beyond_.data(), beyond_.data()));
    const Real agreed = static_cast<Real>(fields_.dot(free, beyond_.data(), scratch_.data()));
    const Real squared = static_cast<Real>(fields_.dot(free, scratch_.data(), scratch_.data()));
    const Real small = kSmallCorrection * model_.mean_edge_m;
    const bool abrupt = !(squared <= small * small * model_.free_count);
    smoothness_ = expected > 0 && !abrupt ? std::clamp<Real>(agreed / expected, 0, 1) : 0;
    std::swap(beyond_, scratch_);
    beyond_dt_s_ = dt;
}

template <class S, class V>
void TypedStepper<S, V>::owe(Real dt) noexcept {
    std::copy_n(solver_.residual().data(), 4 * model_.free_count, owed_.data());
    owed_dt_s_ = dt;
}

template <class S, class V>
void TypedStepper<S, V>::find_results(Real dt) noexcept {
    for (std::size_t k = 0; k < tools_.size(); ++k) {
        const SteppedTool& tool = tools_[k];
        ToolResult& result = results_[k];
        result.force_n = to_array(solution_.force_n[k]);
        result.tool_position_m = to_array(tool.position);
        result.touched_nodes = contact_.load(k).touched + static_cast<std::uint32_t>(tool.anchors.size());
        if (!config_.with_torque) continue;
        Vec torque = contact_.load(k).torque_n_m;
        for (std::size_t i = 0; i < tool.anchors.size(); ++i) {
            const Vec arm = tool.frame.rotation * tool.anchors[i];
            torque += arm.cross(solver_.residual().get(model_.bonded[k].begin + i)) / (dt * dt);
        }
        result.torque_nm = to_array(torque);
    }
}

/// The nodes in a tool's hold with the forces on them, inertia and damping taken out.
template <class S, class V>
void TypedStepper<S, V>::list_held(std::size_t k) noexcept {
    held_.clear();
    const SteppedTool& tool = tools_[k];
    const NodeReader positions(model_.rest_m, displacements_);
    const Real dt2 = step_dt_s_ * step_dt_s_, damping = model_.damping_per_s;
    const std::vector<Constraint>& constraints = contact_.constraints();
    for (std::size_t c = 0; c < constraints.size(); ++c) {
        const Constraint& constraint = constraints[c];
        if (constraint.tool != k) continue;
        const std::uint32_t node = constraint.node;
        const Vec braking =
            beyond_.get(node) / (beyond_dt_s_ * beyond_dt_s_) + damping * velocities_.get(node);
        const Vec row = solution_.row_n[c] + model_.mass_kg[node] * braking;
        const Vec place = positions(node);
        held_.push_back({node,
                         constraint.held,
                         place - tool.position,
                         reaches_[k].outward(tool.frame, place),
                         force_on_tool(constraint, row),
                         {}});
    }
    const Vec further = solution_.displacement.tools[k];
    for (std::size_t i = 0; i < tool.anchors.size(); ++i) {
        const auto node = static_cast<std::uint32_t>(model_.bonded[k].begin + i);
        const Vec braking =
            tool.accelerations[i] - further / dt2 + damping * (tool.velocities[i] - further / step_dt_s_);
        const Vec force = solver_.residual().get(node) / dt2 + model_.mass_kg[node] * braking;
        held_.push_back(
            {node, Mat::Identity(), tool.frame.rotation * tool.anchors[i], Vec::Zero(), force, Mat::Zero()});
    }
}

template <class S, class V>
bool TypedStepper<S, V>::local_model(std::size_t tool, LocalModel& out) noexcept {
    if (!impedance_ || tool >= tools_.size() || !(step_dt_s_ > 0)) return false;
    const NoDenormals no_denormals;
    list_held(tool);
    Impedance found;
    impedance_->find(system(step_dt_s_), preconditioner_, static_cast<std::uint32_t>(tool), held_, found);
    const Frame& frame = tools_[tool].frame;
    out = view_of(frame, found);
    reaches_[tool].describe(frame, held_, NodeReader(model_.rest_m, displacements_), out);
    out.step = steps_;
    return true;
}

template <class S, class V>
StepResult TypedStepper<S, V>::result(std::uint32_t status) const noexcept {
    StepResult result;
    static_cast<ToolResult&>(result) = results_[0];
    result.status = status;
    result.solver_iterations = iterations_;
    return result;
}

template <class S, class V>
StepResult TypedStepper<S, V>::refuse(std::uint32_t status) noexcept {
    for (std::size_t k = 0; k < tools_.size(); ++k) {
        results_[k] = {};
        results_[k].tool_position_m = to_array(tools_[k].position);
    }
    iterations_ = 0;
    step_dt_s_ = 0;
    return result(status);
}

template <class S, class V>
void TypedStepper<S, V>::positions_m(double* out) const noexcept {
    for (std::size_t i = 0; i < model_.from_asset.size(); ++i) {
        const std::uint32_t node = model_.from_asset[i];
        const Vec x = model_.rest_m[node] + displacements_.get(node);
        std::copy_n(x.data(), 3, out + 3 * i);
    }
}

template <class S, class V>
void TypedStepper<S, V>::velocities_m_per_s(double* out) const noexcept {
    for (std::size_t i = 0; i < model_.from_asset.size(); ++i) {
        const Vec v = velocities_.get(model_.from_asset[i]);
        std::copy_n(v.data(), 3, out + 3 * i);
    }
    for (std::size_t i = 0; i < model_.from_asset.size(); ++i) {
        for (std::size_t k = 0; k < tools_.size(); ++k) {
            const Model::Range bonded = model_.bonded[k];
            const std::uint32_t node = model_.from_asset[i];
            if (node >= bonded.begin && node < bonded.end)
                std::copy_n(tools_[k].velocities[node - bonded.begin].data(), 3, out + 3 * i);
        }
    }
}

std::unique_ptr<Stepper> make_stepper(const Asset& asset, const SimulationConfig& config,
                                      const Numerics& numerics, SimdTarget target) {
    if (numerics.arithmetic == Precision::float32)
        return std::make_unique<TypedStepper<float, float>>(asset, config, numerics, target);
    if (numerics.arithmetic == Precision::mixed)
        return std::make_unique<TypedStepper<double, float>>(asset, config, numerics, target);
    return std::make_unique<TypedStepper<double, double>>(asset, config, numerics, target);
}

std::unique_ptr<Stepper> make_stepper(const Asset& asset, const SimulationConfig& config) {
    Numerics numerics = choose_numerics(asset);
    if (config.arithmetic == Arithmetic::float32) numerics.arithmetic = Precision::float32;
    if (config.arithmetic == Arithmetic::float64) numerics.arithmetic = Precision::float64;
    if (config.arithmetic == Arithmetic::mixed) numerics.arithmetic = Precision::mixed;
    if (config.arithmetic == Arithmetic::automatic && numerics.arithmetic == Precision::mixed &&
        config.force_tolerance < kMixedForceTolerance)
        numerics.arithmetic = Precision::float64;
    return make_stepper(asset, config, numerics, best_simd_target());
}

}  // namespace knead::core
