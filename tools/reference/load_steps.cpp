// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/load_steps.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.h"
#include "reference/prescribed_unknowns.h"

namespace knead::tools {
namespace {

// Load steps such as 1/3 add up to one but for rounding: what is left then is not a step of its own.
constexpr double kWhole = 1 - 1e-9;

}  // namespace

StaticSolution equilibrium(const Objective& objective, FreeSystem& system, const PrescribedMotion& motion,
                           const Eigen::VectorXd& target_m, const NewtonLimits& limits,
                           Eigen::VectorXd& positions_m) {
    if (limits.load_steps < 1) fail_input(fmt::format("load steps: {} is not at least 1", limits.load_steps));
    const Eigen::VectorXd start_m = system.given(positions_m);
    const double largest_step = 1.0 / limits.load_steps;
    StaticSolution solution;
    solution.load_steps = 0;
    NewtonOutcome outcome;
    double step = largest_step;
    for (double done = 0; done < 1;) {
        const double next = done + step < kWhole ? done + step : 1;
        Eigen::VectorXd trial = positions_m;
        const Eigen::VectorXd goal = next < 1 ? (start_m + next * (target_m - start_m)).eval() : target_m;
        outcome = {};
        if (follow_prescribed(objective, system, goal, trial))
            outcome = minimise(objective, system, limits.relative_residual, limits.max_iterations, trial,
                               FirstFactor::as_it_is);
        solution.iterations += outcome.iterations + 1;
        if (outcome.converged) {
            positions_m = trial;
            done = next;
            step = std::min(2 * step, largest_step);
            ++solution.load_steps;
            continue;
        }
        step /= 2;
        if (step * limits.max_load_steps < 1)
            fail_result(
                fmt::format("no equilibrium found: {} linear solves, {:.4g} of the motion done in {} load "
                            "steps, then a residual of {:.3g} N where {:.3g} N is wanted; {} free "
                            "unknowns, {} nodes prescribed (too few to hold the object?)",
                            solution.iterations, done, solution.load_steps, outcome.residual_n,
                            outcome.residual_target_n, system.unknown_count(), motion.nodes.size()));
    }
    solution.positions_m = to_points(positions_m);
    const Eigen::VectorXd holding_n = objective.gradient_n(positions_m);
    solution.reactions_n = reactions(motion, holding_n);
    solution.tied_reactions_n = tied_reactions(motion, holding_n);
    solution.energy_j = objective.body->energy_j(positions_m);
    solution.residual_n = outcome.residual_n;
    solution.force_scale_n = outcome.force_scale_n;
    return solution;
}

}  // namespace knead::tools
