// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "baseline/baseline.h"
#include "bench/exact_step.h"

namespace knead::bench {
namespace {

using baseline::Baseline;

using Eigen::Vector3d;

Vector3d vector(const Vec3& v) {
    return {v[0], v[1], v[2]};
}

/// The simulation's state as it hands it out, in double precision.
State state_of(const Simulation& simulation) {
    const auto nodes = static_cast<Eigen::Index>(simulation.node_count());
    State state{Eigen::Map<const Columns>(simulation.positions_m(), 3, nodes), Columns(3, nodes)};
    simulation.velocities_m_per_s(state.velocities_m_per_s.data());
    return state;
}

/// A sampled step: where it was in the motion, and its exact force.
struct Sample {
    std::size_t step = 0;
    Vector3d exact_n;
};

/// Relative to max(|exact|, floor); infinite when `force` is not finite.
double error(const Vector3d& force_n, const Vector3d& exact_n, double floor_n) {
    const double e = (force_n - exact_n).norm() / std::max(exact_n.norm(), floor_n);
    return std::isfinite(e) ? e : HUGE_VAL;
}

void count(const StepResult& result, Accuracy& accuracy) {
    accuracy.forces_n.push_back(result.force_n);
    accuracy.largest_iterations = std::max(accuracy.largest_iterations, result.solver_iterations);
    accuracy.mean_iterations += result.solver_iterations;
    const double force = vector(result.force_n).norm();
    accuracy.finite = accuracy.finite && std::isfinite(force);
    accuracy.largest_force_n = std::max(accuracy.largest_force_n, force);
    if ((result.status & kStepNotConverged) != 0) ++accuracy.not_converged_steps;
    if ((result.status & kStepNotFinite) != 0) ++accuracy.not_finite_steps;
    if (!is_solved(result.status & ~std::uint32_t{kStepNotConverged | kStepNotFinite}))
        ++accuracy.other_status_steps;
}

bool is_sampled(int step, const AccuracyRequest& request) {
    return step < kColdSteps || step % request.sample_every == 0;
}

int step_count(const AccuracyRequest& request) {
    return static_cast<int>(std::lround(request.motion.duration_s / request.dt_s));
}

}  // namespace

Accuracy measure_accuracy(Simulation& simulation, const Body& body, const AccuracyRequest& request) {
    simulation.reset();
    Accuracy accuracy;
    accuracy.steps = step_count(request);
    ExactStep exact(body);
    State truth = body.at_rest();
    std::vector<Vector3d> truth_n;
    std::vector<Sample> samples;
    std::vector<bool> ok;
    for (int k = 0; k < accuracy.steps; ++k) {
        const Pose pose = request.motion.pose(simulation.tool_rest_pose(), (k + 1) * request.dt_s);
        if (is_sampled(k, request) && accuracy.finite)
            samples.push_back(
                {static_cast<std::size_t>(k), exact.step(state_of(simulation), pose, request.dt_s).force_n});
        const StepResult result = simulation.step(pose, request.dt_s);
        count(result, accuracy);
        ok.push_back(is_solved(result.status));
        const Step next = exact.step(truth, pose, request.dt_s);
        truth = next.state;
        truth_n.push_back(next.force_n);
        accuracy.largest_exact_force_n = std::max(accuracy.largest_exact_force_n, next.force_n.norm());
    }
    accuracy.mean_iterations /= std::max(1, accuracy.steps);
    const double floor_n = kSmallestForceShare * accuracy.largest_exact_force_n;
    for (std::size_t k = 0; k < truth_n.size(); ++k)
        accuracy.trajectory_error =
            std::max(accuracy.trajectory_error, error(vector(accuracy.forces_n[k]), truth_n[k], floor_n));
    for (const Sample& s : samples) {
        const double e = error(vector(accuracy.forces_n[s.step]), s.exact_n, floor_n);
        accuracy.step_error = std::max(accuracy.step_error, e);
        if (ok[s.step]) accuracy.step_error_when_ok = std::max(accuracy.step_error_when_ok, e);
    }
    const Columns moved = state_of(simulation).positions_m - body.rest_m;
    accuracy.finite = accuracy.finite && moved.allFinite();
    accuracy.final_deformation_m = std::sqrt(moved.squaredNorm() / static_cast<double>(moved.cols()));
    return accuracy;
}

double baseline_step_error(const Body& body, const AccuracyRequest& request) {
    Baseline baseline(body);
    ExactStep exact(body);
    std::vector<std::pair<Vector3d, Vector3d>> pairs;
    double largest_n = 0;
    for (int k = 0; k < step_count(request); ++k) {
        const Pose pose = request.motion.pose(body.plate_rest, (k + 1) * request.dt_s);
        std::optional<Vector3d> expected;
        if (is_sampled(k, request)) expected = exact.step(baseline.state(), pose, request.dt_s).force_n;
        const Vector3d force = baseline.step(pose, request.dt_s);
        if (!expected) continue;
        pairs.emplace_back(force, *expected);
        largest_n = std::max(largest_n, expected->norm());
    }
    double worst = 0;
    for (const auto& [force, expected] : pairs)
        worst = std::max(worst, error(force, expected, kSmallestForceShare * largest_n));
    return worst;
}

}  // namespace knead::bench
