// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/preconditioner.h"

namespace knead::core {

/// Whether the preconditioned residual is believed as a measure of the error.
enum class Belief : std::uint8_t {
    never,           ///< it may be far too small
    after_watching,  ///< a few iterations, for stiffnesses are far apart
    from_the_start
};

struct SolverLimits {
    int max_iterations = 500;
    Real force_tolerance = 1e-3;             ///< relative, of the force on each tool
    Real velocity_tolerance_m_per_s = 1e-4;  ///< root mean square over the free mass
    Belief belief = Belief::never;
};

/// In: where to start. Out: the solution of one linear system and what the tools feel in it.
template <class S>
struct Solution {
    Unknowns<S> displacement;  ///< expanded
    bool from_zero = false;    ///< in: the displacement is zero everywhere
    /// [constraints] force of the object on the tool at each held node: all of its row, before friction.
    std::vector<Vec> row_n;
    std::vector<Vec> force_n;  ///< [tools] on the hand: sum of the held rows, or the coupling's force
    int iterations = 0;
    bool converged = false;
    bool stopped = false;  ///< by the watcher, before it converged
};

/// Looks at a solution on its way: a system that is about to change need not be solved to the end.
template <class S>
class Watcher {
  public:
    /// After an iteration that left something to do. @return the solve shall stop
    [[nodiscard]] virtual bool stops(const Solution<S>& solution) noexcept = 0;

  protected:
    ~Watcher() = default;
};

/// Conjugate gradients that stop on the force and on the velocities.
///
/// The squared energy norm of the error, E = e^T A e = r^T A^-1 r, bounds the error of a tool's force through
/// the stiffness that the tool feels, and the error of the velocities through the mass; the force alone would
/// let soft nodes drift. It is bounded from above by r^T M^-1 r, because A - M is positive semidefinite;
/// where that is not small enough, it is estimated by the preconditioned residual, corrected by what the
/// decreases of E in the iterations (Hestenes and Stiefel 1952; Strakos and Tichy 2002) have shown of it.
/// Allocates in the constructor only.
template <class S>
class Solver {
  public:
    Solver(const Model& model, std::size_t tools, std::size_t max_constraints);

    /// @param load [nodes] b; the tools' load follows from system.tools
    /// @param solution in: a start, whatever is held; row_n has room for all constraints
    /// @param watcher may be none
    void solve(const System<S>& system, const Preconditioner<S>& preconditioner, const NodeField<S>& load,
               const SolverLimits& limits, Solution<S>& solution, Watcher<S>* watcher = nullptr) noexcept;

    /// Forgets the last steps.
    void reset() noexcept {
        recent_count_ = 0;
        last_iterations_ = 0;
    }

    /// b - A d of the last solve. Rows of bonded tools' nodes are what the tools carry, kg m.
    [[nodiscard]] const NodeField<S>& residual() const noexcept { return residual_.nodes; }

  private:
    class Decreases;

    void start(const System<S>& system, const NodeField<S>& load, Solution<S>& solution) noexcept;
    void start_from_recent(const System<S>& system, Solution<S>& solution) noexcept;
    [[nodiscard]] Real find_curvature(const System<S>& system) noexcept;
    Real advance(const System<S>& system, Real alpha, Solution<S>& solution) noexcept;
    void keep_rows(const System<S>& system, const NodeField<S>& rows, std::vector<Vec>& kept) const noexcept;
    void find_forces(const System<S>& system, Solution<S>& solution) const noexcept;
    [[nodiscard]] bool forces_settled(const System<S>& system, const Preconditioner<S>& preconditioner,
                                      const SolverLimits& limits, const Solution<S>& solution,
                                      Real squared_error, bool after_watching) const noexcept;
    [[nodiscard]] bool velocities_settled(const System<S>& system, const SolverLimits& limits,
                                          Real squared_error) const noexcept;
    [[nodiscard]] bool believes(const System<S>& system, const Preconditioner<S>& preconditioner,
                                const SolverLimits& limits, const Solution<S>& solution, Real rz,
                                const Decreases& decreases) const noexcept;
    void give_momentum(const System<S>& system, Solution<S>& solution) noexcept;
    void remember(const System<S>& system, const Solution<S>& solution, bool first) noexcept;
    [[nodiscard]] Real dot(const System<S>& system, const Unknowns<S>& a,
                           const Unknowns<S>& b) const noexcept;

    Unknowns<S> residual_, direction_, product_, preconditioned_;
    std::vector<Vec> product_rows_;
    std::array<NodeField<S>, 2> recent_;  ///< solutions of the last steps, the newest first
    std::size_t recent_count_ = 0;
    int last_iterations_ = 0;
    bool step_is_new_ = true;  ///< nothing of it is remembered yet
};

}  // namespace knead::core
