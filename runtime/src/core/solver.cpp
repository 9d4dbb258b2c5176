// SPDX-License-Identifier: Apache-2.0
#include "core/solver.h"

#include <algorithm>
#include <cmath>

namespace knead::core {
namespace {

/// Forces below this are not resolved relative to themselves (newtons): a thousandth of what a hand feels.
constexpr Real kForceFloor_n = 1e-5;
/// By how much the preconditioned residual may underestimate the error where it is believed.
constexpr Real kTrust = 4;

/// What is left of the squared error of a force after Preconditioner::force_owed(), where it is believed.
constexpr Real kOwedForce = 0.4;

/// What is known of the error: decreases of its squared energy norm in the last two iterations.
struct Decreases {
    Real last = 0, before = 0;
    int count = 0;

    void add(Real decrease) {
        before = last;
        last = decrease;
        ++count;
    }
};

}  // namespace

template <class S>
Solver<S>::Solver(const Model& model, std::size_t tools, std::size_t max_constraints)
    : product_rows_(max_constraints, Vec::Zero()) {
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
bool Solver<S>::small_enough(const System<S>& system, const Preconditioner<S>& preconditioner,
                             const SolverLimits& limits, const Solution<S>& solution,
                             Real squared_error) const noexcept {
    const Real drift = limits.velocity_tolerance_m_per_s * system.dt_s;
    if (!(squared_error <= system.model.free_mass_kg * drift * drift)) return false;
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        const bool owed = limits.trusts_preconditioner && preconditioner.knows_force_owed(system, k);
        const Real left = owed ? kOwedForce : 1;
        const Real bound = limits.force_tolerance * std::max(solution.force_n[k].norm(), kForceFloor_n);
        if (!(left * preconditioner.force_sensitivity(system, k) * squared_error <= bound * bound))
            return false;
    }
    return true;
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
        if (tool.moves) residual_.tools[k] = -dt2 * tool.force_n - system.tool_diagonal_kg(k) * d.tools[k];
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

template <class S>
void Solver<S>::solve(const System<S>& system, const Preconditioner<S>& preconditioner,
                      const NodeField<S>& load, const SolverLimits& limits, Solution<S>& solution) noexcept {
    start(system, load, solution);
    const FieldKernels<S>& fields = system.fields;
    const std::size_t moving = run_of(system.model.moving_count);
    const std::size_t free = run_of(system.model.free_count);
    const Real to_newtons = 1 / (system.dt_s * system.dt_s);
    Decreases decreases;
    solution.converged = false;
    preconditioner.apply(system, residual_, preconditioned_);
    std::swap(direction_, preconditioned_);
    Real rz = dot(system, residual_, direction_);
    for (solution.iterations = 0; solution.iterations < limits.max_iterations;) {
        if (rz == 0) solution.converged = true;  // nothing left to do, exactly
        if (!(rz > 0)) break;                    // negative or not a number: a failure, never convergence
        system.apply(direction_, product_.nodes);
        keep_rows(system, product_.nodes, product_rows_);
        for (std::size_t k = 0; k < system.tools.size(); ++k) {
            if (system.tools[k].moves) product_.tools[k] = system.tool_diagonal_kg(k) * direction_.tools[k];
        }
        system.project(product_);
        const Real curvature = dot(system, direction_, product_);
        if (!(curvature > 0)) break;
        const Real alpha = rz / curvature;
        ++solution.iterations;
        decreases.add(alpha * rz);

        const Real bound =
            static_cast<Real>(fields.advance(moving, static_cast<S>(alpha), direction_.nodes.data(),
                                             product_.nodes.data(), system.masses.per_kg.data(),
                                             solution.displacement.nodes.data(), residual_.nodes.data())) /
            system.inertia;
        Real tool_bound = 0;
        for (std::size_t k = 0; k < system.tools.size(); ++k) {
            if (!system.tools[k].moves) continue;
            solution.displacement.tools[k] += alpha * direction_.tools[k];
            residual_.tools[k] -= alpha * product_.tools[k];
            tool_bound += residual_.tools[k].squaredNorm() / system.tool_diagonal_kg(k);
        }
        for (std::size_t k = 0; k < system.constraints.size(); ++k)
            solution.row_n[k] -= (alpha * to_newtons) * product_rows_[k];
        find_forces(system, solution);
        if (small_enough(system, preconditioner, limits, solution, bound + tool_bound)) {
            solution.converged = true;
            break;
        }

        preconditioner.apply(system, residual_, preconditioned_);
        const Real next = dot(system, residual_, preconditioned_);
        const bool believed =
            limits.trusts_preconditioner
                ? next >= 0 && small_enough(system, preconditioner, limits, solution, kTrust * next)
                : decreases.count >= 2 && next >= 0 &&
                      small_enough(system, preconditioner, limits, solution,
                                   decreases.last + decreases.before);
        if (believed) {
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
    find_forces(system, solution);
    if (!limits.trusts_preconditioner) return;
    for (std::size_t k = 0; k < system.tools.size(); ++k)
        solution.force_n[k] += preconditioner.force_owed(system, k, residual_.nodes);
}

template class Solver<float>;
template class Solver<double>;

}  // namespace knead::core
