// SPDX-License-Identifier: Apache-2.0
#include "core/solver.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace knead::core {
namespace {

/// Forces below this are not resolved relative to themselves (newtons): a thousandth of what a hand feels.
constexpr Real kForceFloor = 1e-5;
/// Iterations whose decrease estimates the error that is left, and the fewest that say anything.
constexpr std::size_t kWindow = 4;
constexpr int kFewestIterations = 2;

Real dot(const System& system, const Unknowns& a, const Unknowns& b) {
    Real sum = a.tool.dot(b.tool);
    for (std::uint32_t i = 0; i < system.model.free_count; ++i)
        sum += a.nodes[i].dot(b.nodes[i]);
    return sum;
}

void add_scaled(const System& system, Real factor, const Unknowns& b, Unknowns& a) {
    for (std::uint32_t i = 0; i < system.model.free_count; ++i)
        a.nodes[i] += factor * b.nodes[i];
    a.tool += factor * b.tool;
}

/// b = a + factor * b
void update_direction(const System& system, const Unknowns& a, Real factor, Unknowns& b) {
    for (std::uint32_t i = 0; i < system.model.free_count; ++i)
        b.nodes[i] = a.nodes[i] + factor * b.nodes[i];
    b.tool = a.tool + factor * b.tool;
}

/// Sum of the last kWindow decreases of the squared energy norm of the error.
class ErrorEstimate {
  public:
    void add(Real decrease) {
        last_[count_ % kWindow] = decrease;
        ++count_;
    }
    [[nodiscard]] Real squared() const {
        Real sum = 0;
        for (const Real decrease : last_)
            sum += decrease;
        return sum;
    }

  private:
    std::array<Real, kWindow> last_{};
    std::size_t count_ = 0;
};

Vec force_on_hand(const System& system, const Solution& solution) {
    if (system.tool.moves) return system.tool.force_n + system.tool.rate_n_per_m * solution.displacement.tool;
    Vec force = Vec::Zero();
    for (std::size_t k = 0; k < system.constraints.size(); ++k) {
        force += system.constraints[k].held * solution.reaction_n[k];
    }
    return force;
}

/// Largest squared force error for a unit of squared energy error, N^2 / (kg m^2).
Real force_sensitivity(const System& system, const Preconditioner& preconditioner) {
    if (system.tool.moves) {
        return system.tool.rate_n_per_m * system.tool.rate_n_per_m / system.tool_diagonal_kg();
    }
    return preconditioner.tool_stiffness_n_per_m().trace() / (system.dt_s * system.dt_s);
}

}  // namespace

Solver::Solver(const Model& model, std::size_t max_constraints)
    : product_rows_(max_constraints, Vec::Zero()) {
    for (Unknowns* u : {&residual_, &direction_, &product_, &preconditioned_}) {
        u->nodes.assign(model.rest_m.size(), Vec::Zero());
    }
}

void Solver::keep_rows(const System& system, const Unknowns& rows, std::vector<Vec>& kept) const noexcept {
    for (std::size_t k = 0; k < system.constraints.size(); ++k)
        kept[k] = rows.nodes[system.constraints[k].node];
}

void Solver::start(const System& system, const Field& load, Solution& solution) noexcept {
    Unknowns& d = solution.displacement;
    if (!system.tool.moves) d.tool.setZero();
    for (const Constraint& c : system.constraints) {
        Vec& node = d.nodes[c.node];
        node += c.held * (d.tool + c.offset_m - node);
    }
    system.apply(d.nodes, product_.nodes);
    for (std::uint32_t i = 0; i < system.model.free_count; ++i) {
        residual_.nodes[i] = load[i] - product_.nodes[i];
    }
    residual_.tool.setZero();
    if (system.tool.moves) {
        const Real dt2 = system.dt_s * system.dt_s;
        residual_.tool = -dt2 * system.tool.force_n - system.tool_diagonal_kg() * d.tool;
    }
    keep_rows(system, residual_, solution.reaction_n);
    const Real to_newtons = 1 / (system.dt_s * system.dt_s);
    for (std::size_t k = 0; k < system.constraints.size(); ++k)
        solution.reaction_n[k] *= to_newtons;
    system.project(residual_);
}

void Solver::solve(const System& system, const Preconditioner& preconditioner, const Field& load,
                   const SolverLimits& limits, Solution& solution) noexcept {
    start(system, load, solution);
    const Real sensitivity = force_sensitivity(system, preconditioner);
    const Real drift = limits.velocity_tolerance_m_per_s * system.dt_s;
    const Real drift_bound = system.model.free_mass_kg * drift * drift;
    const Real to_newtons = 1 / (system.dt_s * system.dt_s);
    const auto small_enough = [&](Real error) {
        const Real force_bound = limits.force_tolerance * std::max(solution.force_n.norm(), kForceFloor);
        return error <= drift_bound && sensitivity * error <= force_bound * force_bound;
    };

    ErrorEstimate estimate;
    solution.converged = false;
    preconditioner.apply(system, residual_, preconditioned_);
    std::swap(direction_, preconditioned_);
    Real rz = dot(system, residual_, direction_);
    for (solution.iterations = 0; solution.iterations < limits.max_iterations; ++solution.iterations) {
        if (rz == 0) solution.converged = true;  // nothing left to do, exactly
        if (!(rz > 0)) break;                    // negative or not a number: a failure, never convergence
        if (solution.iterations >= kFewestIterations && small_enough(estimate.squared())) {
            solution.converged = true;
            break;
        }
        system.apply(direction_.nodes, product_.nodes);
        product_.tool = system.tool.moves ? Vec(system.tool_diagonal_kg() * direction_.tool) : Vec::Zero();
        keep_rows(system, product_, product_rows_);
        system.project(product_);
        const Real curvature = dot(system, direction_, product_);
        if (!(curvature > 0)) break;
        const Real alpha = rz / curvature;
        add_scaled(system, alpha, direction_, solution.displacement);
        add_scaled(system, -alpha, product_, residual_);
        for (std::size_t k = 0; k < system.constraints.size(); ++k) {
            solution.reaction_n[k] -= (alpha * to_newtons) * product_rows_[k];
        }
        solution.force_n = force_on_hand(system, solution);
        estimate.add(alpha * rz);
        preconditioner.apply(system, residual_, preconditioned_);
        const Real next = dot(system, residual_, preconditioned_);
        update_direction(system, preconditioned_, next / rz, direction_);
        rz = next;
    }
    solution.force_n = force_on_hand(system, solution);
}

}  // namespace knead::core
