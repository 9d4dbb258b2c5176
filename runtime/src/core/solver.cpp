// SPDX-License-Identifier: Apache-2.0
#include "core/solver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/loose_parts.h"

namespace knead::core {
namespace {

/// Forces below this are not resolved relative to themselves (newtons): a thousandth of what a hand feels.
constexpr Real kForceFloor_n = 1e-5;
/// By how much r.z may underestimate the squared error: where it is believed as it is, and beyond what has
/// come to light.
constexpr Real kTrust = 4;
constexpr Real kTrustAfterWatching = 2;
/// The same for z^T M z, as the squared error in the norm of the mass.
constexpr Real kTrustInMass = 4;
/// Iterations that are watched before anything is believed.
constexpr std::size_t kWatched = 2;

/// What is left of the bound of a squared force error after Preconditioner::force_owed(), where it is
/// believed.
constexpr Real kOwedForce = 0.4;
/// The bound is reached by an error that looks like the response to the tool, of which the first iterations
/// leave least: the squared force error was at most this share of the bound in the cases looked at, mostly
/// 0.02.
constexpr Real kForceAfterWatching = 0.08;

/// Iterations of a step from which on the next one starts from its solution: two products for one to three
/// iterations.
constexpr int kManyIterations = 3;

}  // namespace

/// How much of E = e^T A e the iterations took away, and what that says of r.z: what was taken away since is
/// a part of what there was.
template <class S>
class Solver<S>::Decreases {
  public:
    /// @param rz before an iteration  @param decrease of E in it
    void add(Real rz, Real decrease) {
        before_ = last_;
        last_ = decrease;
        rz_[count_ % kKept] = rz;
        sum_[count_ % kKept] = 0;
        ++count_;
        for (std::size_t k = 0; k < std::min(count_, kKept); ++k) {
            sum_[k] += decrease;
            underestimate_ = std::max(underestimate_, sum_[k] / rz_[k]);
        }
    }
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] Real of_last_two() const { return last_ + before_; }
    /// By how much r.z was too small, as far as it has come to light; at least 1.
    [[nodiscard]] Real underestimate() const { return underestimate_; }

  private:
    static constexpr std::size_t kKept = 8;
    std::array<Real, kKept> rz_{}, sum_{};
    std::size_t count_ = 0;
    Real last_ = 0, before_ = 0, underestimate_ = 1;
};

template <class S>
Solver<S>::Solver(const Model& model, std::size_t tools, std::size_t max_constraints)
    : product_rows_(max_constraints, Vec::Zero()) {
    for (NodeField<S>& field : recent_)
        field = NodeField<S>(model.rest_m.size());
    for (Unknowns<S>* u : {&residual_, &direction_, &product_, &preconditioned_}) {
        u->nodes = NodeField<S>(model.rest_m.size());
        u->tools.assign(tools, Vec::Zero());
    }
}

template <class S>
Real Solver<S>::dot(const System<S>& system, const Unknowns<S>& a, const Unknowns<S>& b) const noexcept {
    Real sum =
        static_cast<Real>(system.fields.dot(run_of(system.model.free_count), a.nodes.data(), b.nodes.data()));
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        if (system.tools[k].moves) sum += a.tools[k].dot(b.tools[k]);
    }
    return sum;
}

template <class S>
void Solver<S>::keep_rows(const System<S>& system, const NodeField<S>& rows,
                          std::vector<Vec>& kept) const noexcept {
    for (std::size_t k = 0; k < system.constraints.size(); ++k)
        kept[k] = rows.get(system.constraints[k].node);
}

template <class S>
void Solver<S>::find_forces(const System<S>& system, Solution<S>& solution) const noexcept {
    const Real to_newtons = 1 / (system.dt_s * system.dt_s);
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        const ToolUnknown& tool = system.tools[k];
        Vec& force = solution.force_n[k];
        if (tool.moves) {
            force = tool.force_n + tool.rate_n_per_m * solution.displacement.tools[k];
            continue;
        }
        force.setZero();
        for (std::uint32_t i = system.model.bonded[k].begin; i < system.model.bonded[k].end; ++i)
            force += residual_.nodes.get(i);
        force *= to_newtons;
    }
    for (std::size_t c = 0; c < system.constraints.size(); ++c) {
        const Constraint& constraint = system.constraints[c];
        if (!system.tools[constraint.tool].moves)
            solution.force_n[constraint.tool] += force_on_tool(constraint, solution.row_n[c]);
    }
}

template <class S>
bool Solver<S>::forces_settled(const System<S>& system, const Preconditioner<S>& preconditioner,
                               const SolverLimits& limits, const Solution<S>& solution, Real squared_error,
                               bool after_watching) const noexcept {
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        const bool owed =
            limits.belief == Belief::from_the_start && preconditioner.knows_force_owed(system, k);
        const Real left = owed ? kOwedForce : after_watching ? kForceAfterWatching : 1;
        const Real bound = limits.force_tolerance * std::max(solution.force_n[k].norm(), kForceFloor_n);
        if (!(left * preconditioner.force_sensitivity(system, k) * squared_error <= bound * bound))
            return false;
    }
    return true;
}

template <class S>
bool Solver<S>::velocities_settled(const System<S>& system, const SolverLimits& limits,
                                   Real squared_error) const noexcept {
    const Real drift = limits.velocity_tolerance_m_per_s * system.dt_s;
    return squared_error <= system.model.free_mass_kg * drift * drift;
}

template <class S>
void Solver<S>::start(const System<S>& system, const NodeField<S>& load, Solution<S>& solution) noexcept {
    Unknowns<S>& d = solution.displacement;
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        if (!system.tools[k].moves) d.tools[k].setZero();
    }
    for (const Constraint& c : system.constraints) {
        const Vec node = d.nodes.get(c.node);
        d.nodes.set(c.node, node + c.held * (d.tools[c.tool] + c.offset_m - node));
    }
    if (solution.from_zero && system.constraints.empty()) {
        residual_.nodes.copy(load);
    } else {
        system.apply(d, product_.nodes);
        system.fields.add_scaled(load.size(), load.data(), S(-1), product_.nodes.data(),
                                 residual_.nodes.data());
    }
    solution.from_zero = false;
    const Real dt2 = system.dt_s * system.dt_s;
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        const ToolUnknown& tool = system.tools[k];
        residual_.tools[k].setZero();
        if (tool.moves)
            residual_.tools[k] =
                -dt2 * (tool.force_n + tool.inertia_n) - system.tool_diagonal_kg(k) * d.tools[k];
    }
    keep_rows(system, residual_.nodes, solution.row_n);
    for (std::size_t k = 0; k < system.constraints.size(); ++k) {
        const Constraint& c = system.constraints[k];
        solution.row_n[k] /= dt2;
        const Vec friction = dt2 * c.friction_n;
        residual_.nodes.add(c.node, friction);
        if (system.tools[c.tool].moves) residual_.tools[c.tool] -= friction;
    }
    system.project(residual_);
}

/// Whether the error is small enough as far as can be told. @param rz not negative
template <class S>
bool Solver<S>::believes(const System<S>& system, const Preconditioner<S>& preconditioner,
                         const SolverLimits& limits, const Solution<S>& solution, Real rz,
                         const Decreases& decreases) const noexcept {
    const bool watches = limits.belief == Belief::after_watching;
    if (limits.belief != Belief::from_the_start && decreases.count() < kWatched) return false;
    const Real energy = limits.belief == Belief::never ? decreases.of_last_two()
                        : watches                      ? kTrustAfterWatching * decreases.underestimate() * rz
                                                       : kTrust * rz;
    if (!forces_settled(system, preconditioner, limits, solution, energy, watches)) return false;
    if (velocities_settled(system, limits, energy)) return true;
    if (limits.belief == Belief::never) return false;
    // Stiff matter makes E far greater than the velocities are.
    const Real in_mass = static_cast<Real>(system.fields.weighted_square(
        run_of(system.model.free_count), system.masses.kg.data(), preconditioned_.nodes.data()));
    // What makes r.z too small makes this too small.
    const Real too_small = watches ? decreases.underestimate() : 1;
    return velocities_settled(system, limits, kTrustInMass * too_small * in_mass);
}

/// product_ = A direction_, projected. @return direction_ . product_
template <class S>
Real Solver<S>::find_curvature(const System<S>& system) noexcept {
    system.apply(direction_, product_.nodes);
    keep_rows(system, product_.nodes, product_rows_);
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        if (system.tools[k].moves) product_.tools[k] = system.tool_diagonal_kg(k) * direction_.tools[k];
    }
    system.project(product_);
    return dot(system, direction_, product_);
}

/// Goes along direction_. @return bound of the squared energy error
template <class S>
Real Solver<S>::advance(const System<S>& system, Real alpha, Solution<S>& solution) noexcept {
    const Real nodes = static_cast<Real>(
        system.fields.advance(run_of(system.model.moving_count), static_cast<S>(alpha),
                              direction_.nodes.data(), product_.nodes.data(), system.masses.per_kg.data(),
                              solution.displacement.nodes.data(), residual_.nodes.data()));
    Real tools = 0;
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        if (!system.tools[k].moves) continue;
        solution.displacement.tools[k] += alpha * direction_.tools[k];
        residual_.tools[k] -= alpha * product_.tools[k];
        tools += residual_.tools[k].squaredNorm() / system.tool_diagonal_kg(k);
    }
    const Real to_newtons = 1 / (system.dt_s * system.dt_s);
    for (std::size_t k = 0; k < system.constraints.size(); ++k)
        solution.row_n[k] -= (alpha * to_newtons) * product_rows_[k];
    return nodes / system.inertia + tools;
}

/// Goes to the best point in the span of the last steps' solutions.
template <class S>
void Solver<S>::start_from_recent(const System<S>& system, Solution<S>& solution) noexcept {
    const std::size_t free = run_of(system.model.free_count);
    Real curvature = 0;
    for (std::size_t k = 0; k < recent_count_; ++k) {
        const NodeField<S>& guess = recent_[k];
        Real along = 0;
        if (curvature > 0)
            along =
                static_cast<Real>(system.fields.dot(free, guess.data(), product_.nodes.data())) / curvature;
        system.fields.add_scaled(free, guess.data(), static_cast<S>(-along), direction_.nodes.data(),
                                 direction_.nodes.data());
        for (Vec& tool : direction_.tools)
            tool.setZero();
        system.expand(direction_);
        curvature = find_curvature(system);
        if (!(curvature > 0)) return;
        (void)advance(system, dot(system, residual_, direction_) / curvature, solution);
    }
}

/// What is left of the momentum of what nothing holds. It is a translation, exactly, for K knows none, and of
/// stiff matter the preconditioned residual hardly sees it.
template <class S>
void Solver<S>::give_momentum(const System<S>& system, Solution<S>& solution) noexcept {
    const Model& model = system.model;
    for (const LoosePart& part : model.loose_parts) {
        if (is_touched(part, system.constraints)) continue;
        Vec left = Vec::Zero();
        for (const std::uint32_t i : part.nodes)
            left += residual_.nodes.get(i);
        const Vec way = left / (system.inertia * part.mass_kg);
        for (const std::uint32_t i : part.nodes) {
            solution.displacement.nodes.add(i, way);
            residual_.nodes.add(i, -(system.inertia * model.mass_kg[i]) * way);
        }
    }
}

/// @param first of the step: else it takes the place of what the step had before
template <class S>
void Solver<S>::remember(const System<S>& system, const Solution<S>& solution, bool first) noexcept {
    last_iterations_ = solution.iterations;
    if (!solution.converged || solution.iterations + 1 < kManyIterations) {
        recent_count_ = 0;
        return;
    }
    if (first || recent_count_ == 0) {
        std::swap(recent_[0], recent_[1]);
        recent_count_ = std::min(recent_count_ + 1, recent_.size());
    }
    std::copy_n(solution.displacement.nodes.data(), 4 * system.model.free_count, recent_[0].data());
}

template <class S>
void Solver<S>::solve(const System<S>& system, const Preconditioner<S>& preconditioner,
                      const NodeField<S>& load, const SolverLimits& limits, Solution<S>& solution,
                      Watcher<S>* watcher) noexcept {
    const bool first = solution.from_zero;
    if (first) step_is_new_ = true;
    start(system, load, solution);
    if (first && last_iterations_ >= kManyIterations) start_from_recent(system, solution);
    const FieldKernels<S>& fields = system.fields;
    const std::size_t free = run_of(system.model.free_count);
    Decreases decreases;
    solution.converged = solution.stopped = false;
    preconditioner.apply(system, residual_, preconditioned_);
    std::swap(direction_, preconditioned_);
    Real rz = dot(system, residual_, direction_);
    for (solution.iterations = 0; solution.iterations < limits.max_iterations;) {
        if (rz == 0) solution.converged = true;  // nothing left to do, exactly
        if (!(rz > 0)) break;                    // negative or not a number: a failure, never convergence
        const Real curvature = find_curvature(system);
        if (curvature == 0) solution.converged = true;  // A is definite: beneath the smallest numbers
        if (!(curvature > 0)) break;
        const Real alpha = rz / curvature;
        ++solution.iterations;
        decreases.add(rz, alpha * rz);

        const Real bound = advance(system, alpha, solution);
        find_forces(system, solution);
        if (velocities_settled(system, limits, bound) &&
            forces_settled(system, preconditioner, limits, solution, bound, false)) {
            solution.converged = true;
            break;
        }
        if (watcher != nullptr && watcher->stops(solution)) {
            solution.stopped = true;
            return;
        }

        preconditioner.apply(system, residual_, preconditioned_);
        const Real next = dot(system, residual_, preconditioned_);
        if (next >= 0 && believes(system, preconditioner, limits, solution, next, decreases)) {
            solution.converged = true;
            break;
        }
        const Real beta = next / rz;
        fields.add_scaled(free, preconditioned_.nodes.data(), static_cast<S>(beta), direction_.nodes.data(),
                          direction_.nodes.data());
        for (std::size_t k = 0; k < system.tools.size(); ++k)
            direction_.tools[k] = preconditioned_.tools[k] + beta * direction_.tools[k];
        rz = next;
    }
    give_momentum(system, solution);
    find_forces(system, solution);
    remember(system, solution, step_is_new_);
    step_is_new_ = false;
    if (limits.belief != Belief::from_the_start) return;
    for (std::size_t k = 0; k < system.tools.size(); ++k)
        solution.force_n[k] += preconditioner.force_owed(system, k, residual_.nodes);
}

template class Solver<float>;
template class Solver<double>;

}  // namespace knead::core
