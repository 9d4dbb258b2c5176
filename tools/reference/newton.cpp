// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knead::tools {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kSufficientDecrease = 1e-4;  // Armijo's share of the decrease that the slope promises
constexpr double kSmallestStep = 1e-12;
// Promised decreases below this share of the objective drown in the rounding of its sum over the tetrahedra:
// there the residual decides instead.
constexpr double kUnseenDecrease = 1e-9;
// A factor that still brings the residual below this share of it is kept: a solve costs a tenth of a factor.
constexpr double kKeepFactor = 0.2;

/// Norms of the gradient over the free and over the prescribed unknowns.
struct SplitNorm {
    double free_n = 0;
    double prescribed_n = 0;
};

SplitNorm split_norm(const Eigen::VectorXd& gradient, const std::vector<bool>& is_prescribed) {
    double free_sum = 0;
    double prescribed_sum = 0;
    for (Eigen::Index k = 0; k < gradient.size(); ++k)
        (is_prescribed[static_cast<std::size_t>(k)] ? prescribed_sum : free_sum) += gradient[k] * gradient[k];
    return {std::sqrt(free_sum), std::sqrt(prescribed_sum)};
}

double free_dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const std::vector<bool>& is_prescribed) {
    double sum = 0;
    for (Eigen::Index k = 0; k < a.size(); ++k)
        if (!is_prescribed[static_cast<std::size_t>(k)]) sum += a[k] * b[k];
    return sum;
}

/// Factorises the exact second derivative, or the projected one where that is not positive definite.
bool factorise(const Objective& objective, FreeSystem& system, const Eigen::VectorXd& positions_m,
               Curvature& used) {
    used = Curvature::exact;
    if (system.factorise(positions_m, used, objective.weight_n_per_m)) return true;
    used = Curvature::projected;
    return system.factorise(positions_m, used, objective.weight_n_per_m);
}

/// Goes along `direction` until the objective has fallen enough; updates positions and gradient.
bool line_search(const Objective& objective, const FreeSystem& system, const Eigen::VectorXd& direction,
                 Eigen::VectorXd& positions_m, Eigen::VectorXd& gradient) {
    const std::vector<bool>& is_prescribed = system.is_prescribed();
    const double start_j = objective.value_j(positions_m);
    const Eigen::VectorXd reduced = system.reduced(gradient);
    const double slope_j = free_dot(reduced, direction, is_prescribed);
    const double residual_n = split_norm(reduced, is_prescribed).free_n;
    for (double step = 1; step >= kSmallestStep; step /= 2) {
        const Eigen::VectorXd trial = positions_m + step * direction;
        const double value_j = objective.value_j(trial);
        const bool falls = value_j <= start_j + kSufficientDecrease * step * slope_j;
        const bool unseen = -slope_j <= kUnseenDecrease * std::abs(start_j);
        if (!std::isfinite(value_j) || (!falls && !unseen)) continue;
        Eigen::VectorXd trial_gradient = objective.gradient_n(trial);
        if (unseen && !(split_norm(system.reduced(trial_gradient), is_prescribed).free_n < residual_n))
            continue;
        positions_m = trial;
        gradient = std::move(trial_gradient);
        return true;
    }
    return false;
}

/// Fills the norms of `outcome` and says whether they are small enough.
void judge(const Objective& objective, const FreeSystem& system, double relative_residual,
           const Eigen::VectorXd& positions_m, const Eigen::VectorXd& gradient, NewtonOutcome& outcome) {
    const SplitNorm norm = split_norm(system.reduced(gradient), system.is_prescribed());
    outcome.residual_n = norm.free_n;
    outcome.force_scale_n = norm.prescribed_n;
    if (objective.weight_n_per_m.size() > 0) {
        const Eigen::VectorXd inertia =
            objective.weight_n_per_m.cwiseProduct(positions_m - objective.anchor_m);
        outcome.force_scale_n = std::max(outcome.force_scale_n, inertia.norm());
    }
    outcome.residual_target_n =
        std::max(relative_residual * outcome.force_scale_n, objective.rounding_noise_n());
    outcome.converged = outcome.residual_n <= outcome.residual_target_n;
}

}  // namespace

Eigen::VectorXd stiffness_times(const ElasticBody& body, const Eigen::VectorXd& positions_m,
                                Curvature curvature, const Eigen::VectorXd& direction) {
    Eigen::VectorXd product = Eigen::VectorXd::Zero(direction.size());
    for (std::size_t t = 0; t < body.tetrahedron_count(); ++t) {
        const Tetrahedron& nodes = body.nodes_of(t);
        Eigen::Matrix<double, 3, 4> local;
        for (int a = 0; a < 4; ++a)
            local.col(a) = direction.segment<3>(first_unknown(nodes[a]));
        if (local.isZero(0)) continue;
        local.reshaped() = body.stiffness_n_per_m(t, positions_m, curvature) * local.reshaped().eval();
        for (int a = 0; a < 4; ++a)
            product.segment<3>(first_unknown(nodes[a])) += local.col(a);
    }
    return product;
}

double Objective::value_j(const Eigen::VectorXd& positions_m) const {
    double value = body->energy_j(positions_m);
    if (weight_n_per_m.size() > 0) value += weight_n_per_m.dot((positions_m - anchor_m).cwiseAbs2()) / 2;
    return value;
}

Eigen::VectorXd Objective::gradient_n(const Eigen::VectorXd& positions_m) const {
    Eigen::VectorXd gradient = body->gradient_n(positions_m);
    if (weight_n_per_m.size() > 0) gradient += weight_n_per_m.cwiseProduct(positions_m - anchor_m);
    return gradient;
}

double Objective::rounding_noise_n() const {
    double noise = body->rounding_noise_n();
    if (weight_n_per_m.size() > 0)
        noise = std::max(
            noise, kEpsilon * weight_n_per_m.lpNorm<Eigen::Infinity>() * anchor_m.lpNorm<Eigen::Infinity>());
    return noise;
}

bool follow_prescribed(const Objective& objective, FreeSystem& system, const Eigen::VectorXd& target_m,
                       Eigen::VectorXd& positions_m) {
    Eigen::VectorXd move = positions_m;
    system.put_given(target_m, move);
    move -= positions_m;
    if (move.isZero(0)) return true;
    Curvature used{};
    if (!factorise(objective, system, positions_m, used)) return false;
    const Eigen::VectorXd force =
        objective.gradient_n(positions_m) + stiffness_times(*objective.body, positions_m, used, move);
    Eigen::VectorXd moved = positions_m + move + system.solve(-force);
    if (!moved.allFinite()) return false;
    system.put_given(target_m, moved);
    positions_m = std::move(moved);
    return true;
}

NewtonOutcome minimise(const Objective& objective, FreeSystem& system, double relative_residual,
                       int max_iterations, Eigen::VectorXd& positions_m, FirstFactor first) {
    NewtonOutcome outcome;
    Eigen::VectorXd gradient = objective.gradient_n(positions_m);
    judge(objective, system, relative_residual, positions_m, gradient, outcome);
    bool factor_serves = first == FirstFactor::as_it_is && system.has_factor();
    while (!outcome.converged && outcome.iterations < max_iterations) {
        Curvature used{};
        const bool fresh = !factor_serves;
        if (fresh && !factorise(objective, system, positions_m, used)) return outcome;
        const Eigen::VectorXd direction = system.solve(-gradient);
        ++outcome.iterations;
        const double before_n = outcome.residual_n;
        const bool went =
            direction.allFinite() && line_search(objective, system, direction, positions_m, gradient);
        if (!went && fresh) return outcome;
        if (went) judge(objective, system, relative_residual, positions_m, gradient, outcome);
        factor_serves = went && first == FirstFactor::as_it_is && outcome.residual_n < kKeepFactor * before_n;
    }
    return outcome;
}

}  // namespace knead::tools
