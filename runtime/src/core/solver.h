// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/preconditioner.h"

namespace knead::core {

struct SolverLimits {
    int max_iterations = 500;
    Real force_tolerance = 1e-4;             ///< relative, of the force on the hand
    Real velocity_tolerance_m_per_s = 1e-4;  ///< root mean square over the free mass
};

/// In: where to start. Out: the solution of one linear system and what the tool feels in it.
struct Solution {
    Unknowns displacement;  ///< expanded
    std::vector<Vec>
        reaction_n;  ///< [constraints] force of the object on the tool at each held node, all of its row
    Vec force_n = Vec::Zero();  ///< on the hand: sum of the held reactions, or the coupling's force
    int iterations = 0;
    bool converged = false;
};

/// Conjugate gradients that stop on the force and on the velocities.
///
/// The error in the energy norm is estimated by the decrease of the last iterations (Hestenes and Stiefel
/// 1952; Strakos and Tichy 2002). It bounds the error of the tool's force through the stiffness the tool
/// feels, and the velocity error through the mass; the force alone would let soft nodes drift. Allocates in
/// the constructor only.
class Solver {
  public:
    Solver(const Model& model, std::size_t max_constraints);

    /// @param load [nodes] b; the tool's load follows from system.tool
    /// @param solution in: a start, whatever is held; reaction_n has room for all constraints
    void solve(const System& system, const Preconditioner& preconditioner, const Field& load,
               const SolverLimits& limits, Solution& solution) noexcept;

  private:
    void start(const System& system, const Field& load, Solution& solution) noexcept;
    /// Rows of held nodes, before they are projected: the tool's reaction comes from here.
    void keep_rows(const System& system, const Unknowns& rows, std::vector<Vec>& kept) const noexcept;

    Unknowns residual_, direction_, product_, preconditioned_;
    std::vector<Vec> product_rows_;
};

}  // namespace knead::core
