// SPDX-License-Identifier: Apache-2.0
#include "bench/speed.h"

#include <algorithm>
#include <chrono>

#include "baseline/baseline.h"
#include "bench/allocation.h"
#include "bench/scene.h"

namespace knead::bench {
namespace {

using baseline::Baseline;

// Google Benchmark times a loop as a whole. Here every step is timed for its percentiles, and runtime and
// baseline take turns so that whatever else the machine does hits both: hence a loop of our own.

constexpr double kDtS = 1e-3;
constexpr double kWayM = 0.1 * kSideM;
constexpr double kSpeedMPerS = 0.1;
constexpr double kPressS = 0.25;  // then comes the next cold start
/// Radians between the tremors of one press and the next: no two alike.
constexpr double kPhaseStep = 2.4;
constexpr int kSliceSteps = 50;
constexpr int kBaselineSliceSteps = 10;
/// First steps of a slice bring data back into the caches that the other one used; they are not counted.
constexpr int kWarmUpSteps = 2;
constexpr int kLoadRepetitions = 9;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One press after the other, each from rest.
class Presses {
  public:
    explicit Presses(const Pose& rest) : rest_(rest), motion_(press(kWayM, kSpeedMPerS, kPressS, 0)) {}

    /// Is the step to come the first of a press?
    [[nodiscard]] bool starts() const { return step_ == 0; }
    [[nodiscard]] int count() const { return count_ + 1; }
    Pose next() {
        const Pose pose = motion_.pose(rest_, (step_ + 1) * kDtS);
        if (++step_ * kDtS >= motion_.duration_s) {
            step_ = 0;
            motion_ = press(kWayM, kSpeedMPerS, kPressS, kPhaseStep * ++count_);
        }
        return pose;
    }

  private:
    Pose rest_;
    Motion motion_;
    int step_ = 0;
    int count_ = 0;
};

/// Runtime and baseline in turns; fills the timed part of the row.
void time_in_turns(const SpeedRequest& request, Simulation& simulation, Baseline& baseline,
                   std::vector<Vec3>& first_forces, SpeedRow& row) {
    Presses presses(simulation.tool_rest_pose());
    Presses baseline_presses(simulation.tool_rest_pose());
    const auto all = static_cast<std::size_t>(request.steps);
    std::vector<double> us, baseline_us;
    us.reserve(all + kSliceSteps);
    baseline_us.reserve(all + kSliceSteps);
    first_forces.reserve(static_cast<std::size_t>(kPressS / kDtS) + 1);
    double iterations = 0, baseline_iterations = 0;
    int steps = 0, baseline_steps = 0;
    const auto start = Clock::now();
    while (us.size() < all && (us.size() < kSliceSteps || seconds_since(start) < request.budget_s)) {
        const std::uint64_t calls = allocation_count().calls;
        std::uint64_t motion_calls = 0;  // made by the motion, not by the step
        for (int k = 0; k < kSliceSteps; ++k, ++steps) {
            if (presses.starts()) simulation.reset();
            const std::uint64_t before_motion = allocation_count().calls;
            const Pose pose = presses.next();
            motion_calls += allocation_count().calls - before_motion;
            const auto from = Clock::now();
            const StepResult result = simulation.step(pose, kDtS);
            const double took_us = 1e6 * seconds_since(from);
            if (k >= kWarmUpSteps) us.push_back(took_us);
            if (first_forces.size() < first_forces.capacity()) first_forces.push_back(result.force_n);
            iterations += result.solver_iterations;
            row.largest_iterations = std::max(row.largest_iterations, result.solver_iterations);
            row.bad_status_steps += result.status == kStepOk ? 0 : 1;
        }
        row.allocations += allocation_count().calls - calls - motion_calls;
        for (int k = 0; k < kBaselineSliceSteps; ++k, ++baseline_steps) {
            if (baseline_presses.starts()) baseline.reset();
            const Pose pose = baseline_presses.next();
            const auto from = Clock::now();
            (void)baseline.step(pose, kDtS);
            const double took_us = 1e6 * seconds_since(from);
            if (k >= kWarmUpSteps) baseline_us.push_back(took_us);
            baseline_iterations += baseline.iterations();
        }
    }
    row.cold_starts = presses.count();
    row.timed_steps = static_cast<int>(us.size());
    row.baseline_timed_steps = static_cast<int>(baseline_us.size());
    row.us = baseline::percentiles(us);
    row.baseline_us = baseline::percentiles(baseline_us);
    row.ratio = row.baseline_us.p50 / row.us.p50;
    row.mean_iterations = iterations / steps;
    row.baseline_mean_iterations = baseline_iterations / baseline_steps;
}

void compare(const SpeedRequest& request, Simulation& simulation, const Body& body,
             const std::vector<Vec3>& first_forces, SpeedRow& row) {
    AccuracyRequest accuracy;
    for (int k = 0; k < request.accuracy_motions; ++k) {
        accuracy.motion = press(kWayM, kSpeedMPerS, request.accuracy_s, kPhaseStep * k);
        const Accuracy found = measure_accuracy(simulation, body, accuracy);
        row.force_error = std::max(row.force_error, found.step_error);
        row.trajectory_error = std::max(row.trajectory_error, found.trajectory_error);
        if (k > 0) continue;
        const std::size_t both = std::min(found.forces_n.size(), first_forces.size());
        row.repeatable =
            std::equal(found.forces_n.begin(), found.forces_n.begin() + static_cast<std::ptrdiff_t>(both),
                       first_forces.begin());
        row.baseline_force_error = baseline_step_error(body, accuracy);
    }
}

}  // namespace

SpeedRow measure_speed(const SpeedRequest& request) {
    const Asset asset = bake_scene(press_scene(), scenario_cube(request.cells));
    const Body body = make_body(asset);
    SpeedRow row;
    row.cells = request.cells;
    row.tetrahedra = asset.tetrahedra.size();
    row.nodes = asset.nodes_m.size();
    row.loading = measure_loading(asset, kLoadRepetitions);
    Simulation simulation = make_simulation(asset);
    row.preconditioner_bytes = simulation.preconditioner_bytes();
    std::vector<Vec3> first_forces;
    {
        Baseline baseline(body);
        time_in_turns(request, simulation, baseline, first_forces, row);
    }
    row.bound = step_bound(step_sizes(body), row.baseline_mean_iterations, request.flops_per_s);
    compare(request, simulation, body, first_forces, row);
    return row;
}

}  // namespace knead::bench
