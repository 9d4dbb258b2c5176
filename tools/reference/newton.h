// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "reference/elastic_body.h"
#include "reference/free_system.h"

namespace knead::tools {

/// What is minimised over the free unknowns: elastic energy + 1/2 sum_k weight_k (x_k - anchor_k)^2.
///
/// Without weights: equilibrium. With weights mass / dt^2 and anchors where the body would fly to without
/// elasticity: one implicit Euler step.
struct Objective {
    const ElasticBody* body = nullptr;
    Eigen::VectorXd weight_n_per_m;  ///< [3 nodes] or empty
    Eigen::VectorXd anchor_m;        ///< [3 nodes] or empty

    [[nodiscard]] double value_j(const Eigen::VectorXd& positions_m) const;
    [[nodiscard]] Eigen::VectorXd gradient_n(const Eigen::VectorXd& positions_m) const;
    /// Bound on the rounding left in an entry of the gradient.
    [[nodiscard]] double rounding_noise_n() const;
};

/// The elastic second derivative at `positions_m` times `direction`, tetrahedron by tetrahedron.
[[nodiscard]] Eigen::VectorXd stiffness_times(const ElasticBody& body, const Eigen::VectorXd& positions_m,
                                              Curvature curvature, const Eigen::VectorXd& direction);

/// How a minimisation ended.
struct NewtonOutcome {
    bool converged = false;
    int iterations = 0;        ///< linear solves
    double residual_n = 0;     ///< Euclidean norm of the gradient over the free unknowns
    double force_scale_n = 0;  ///< what the residual is compared with: see minimise()
    double residual_target_n = 0;
};

/// Moves the prescribed unknowns to their places in `target_m` and the free ones along with them by one
/// linear solve at the current positions: a far better start than moving the prescribed ones alone, which may
/// flatten the tetrahedra beside them.
/// @return false when the system is singular or the result not finite; `positions_m` is then unchanged
[[nodiscard]] bool follow_prescribed(const Objective& objective, FreeSystem& system,
                                     const Eigen::VectorXd& target_m, Eigen::VectorXd& positions_m);

/// Whether the factor that a FreeSystem has may serve the first iterations.
enum class FirstFactor {
    anew,     ///< plain Newton: a factor for each iteration
    as_it_is  ///< a factor is kept, from before too, for as long as the residual falls fast with it
};

/// Newton's method with a backtracking line search on the objective.
///
/// Exact second derivative when it is positive definite, else the per-element projection of it. Converged
/// when the residual is at most `relative_residual` times the force scale (the larger of the reactions at the
/// prescribed unknowns and the weights' forces), or has reached the rounding noise of the forces.
[[nodiscard]] NewtonOutcome minimise(const Objective& objective, FreeSystem& system, double relative_residual,
                                     int max_iterations, Eigen::VectorXd& positions_m,
                                     FirstFactor first = FirstFactor::anew);

}  // namespace knead::tools
