// SPDX-License-Identifier: Apache-2.0
// Steps that are linearised again against converged nonlinear steps of the reference, which shares no code.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/implicit_euler.h"
#include "stability/contact_runs.h"
#include "stability/touch.h"
#include "support/simulation_of.h"

namespace knead::test {
namespace {

constexpr std::uint32_t kCells = 4;
constexpr double kLongDtS = 10e-3;
constexpr int kSteps = 60;
constexpr int kEnough = 50;  ///< linearisations

/// Down by 20 % from a little above, aside with a turn, and off.
std::vector<Pose> quick_press(const std::vector<Pose>& rest, double time_s) {
    const double down = ramp(time_s, 0, 0.1), aside = ramp(time_s, 0.1, 0.3), up = ramp(time_s, 0.4, 0.5);
    const Vec3 way{0.01 * aside, 0, 0.001 - 0.021 * down + 0.03 * up};
    return {moved(rest[0], way, Eigen::AngleAxisd(0.3 * aside, Eigen::Vector3d::UnitZ()))};
}

/// Solved to the end, so that linearisation is all that is left.
SimulationConfig solved(int linearisations) {
    SimulationConfig config;
    config.arithmetic = Arithmetic::float64;
    config.expected_dt_s = kLongDtS;
    config.force_tolerance = 1e-8;
    config.max_contact_passes = 200;
    config.max_linearisations = linearisations;
    return config;
}

// What is left when a step moves no more than kNearlyLinear (runtime/src/core/linearisations.h): its square
// is of the order of the next correction. Measured up to 4.3e-5.
constexpr double kConvergedError = 1e-4;
// One linearisation of the same motions: measured 1.7e-3 and 1.9e-3.
constexpr double kOnceError = 1e-3;

TEST(Linearisation, Again_where_the_solution_came_converges_to_the_nonlinear_step_in_contact) {
    // Of the tools, only a plate that slips is the same problem in every linearisation: tangent planes and
    // places of catch are those of the first.
    const ContactScene scene = touched_cube({ToolShape::plate, ToolContact::frictionless}, kCells);
    const Record truth = run_reference(scene, quick_press, kLongDtS, kSteps, Oracle::converged);
    const Difference once =
        difference(run_runtime(scene, quick_press, kLongDtS, kSteps, solved(1)), truth, 0);
    const Record run = run_runtime(scene, quick_press, kLongDtS, kSteps, solved(kEnough));
    const Difference again = difference(run, truth, 0);
    EXPECT_EQ(run.status, kStepOk);
    EXPECT_GT(once.force, kOnceError) << "or the motion shows nothing: " << text(once);
    EXPECT_LT(again.force, kConvergedError) << text(again);
    EXPECT_LT(again.torque, kConvergedError) << text(again);
    EXPECT_EQ(again.steps_apart, 0) << text(again);
    RecordProperty("once", text(once));
    RecordProperty("again", text(again));
}

/// Largest error of the force on a bonded plate that goes down by 10 % in 50 ms, over the largest force.
double bonded_error(const PressedCube& cube, int linearisations) {
    Simulation simulation = simulation_of(press_asset(cube).asset, solved(linearisations));
    const Pose rest = simulation.tool_rest_pose();
    tools::ImplicitEuler reference(cube.mesh, cube.material);
    tools::MotionState state = reference.rest();
    tools::PrescribedMotion motion = cube.press.motion;
    double largest_n = 0, error_n = 0;
    for (int k = 1; k <= kSteps; ++k) {
        const double way_m = cube.way_m() * ramp(k * kLongDtS, 0, 0.05);
        Pose pose = rest;
        pose.position_m[2] -= way_m;
        for (std::size_t p = cube.press.held_nodes.size(); p < motion.nodes.size(); ++p)
            motion.displacement_m[p] = {0, 0, -way_m};
        const StepResult step = simulation.step(pose, kLongDtS);
        EXPECT_EQ(step.status, kStepOk) << "step " << k;
        const tools::MotionStep expected = reference.step(state, motion, kLongDtS);
        state = expected.state;
        const Eigen::Vector3d truth = vec(tools::force_on_plate_n(cube.press, expected.solution));
        largest_n = std::max(largest_n, truth.norm());
        error_n = std::max(error_n, (vec(step.force_n) - truth).norm());
    }
    return error_n / largest_n;
}

TEST(Linearisation, Again_where_the_solution_came_converges_to_the_nonlinear_step_of_a_bonded_plate) {
    const PressedCube cube({1, kCells});
    EXPECT_GT(bonded_error(cube, 1), kOnceError) << "or the motion shows nothing";
    EXPECT_LT(bonded_error(cube, kEnough), kConvergedError);
}

/// A jerk so small that the object answers linearly: linearised again, a step must come to the same. With a
/// heavy tool, whose inertia is in the equations too.
TEST(LinearisationOfACoupledTool, Again_changes_nothing_that_is_linear) {
    constexpr double kJerkM = 2e-5;
    ContactScene scene = touched_cube({ToolShape::plate, ToolContact::bonded}, kCells);
    scene.asset.damping_per_s = 20;
    const auto run = [&](int linearisations) {
        SimulationConfig config = solved(linearisations);
        config.coupling_stiffness_n_per_m = 2000;
        config.coupling_damping_n_s_per_m = 5;
        config.tool_mass_kg = 0.5;
        return run_runtime(
            scene,
            [](const std::vector<Pose>& rest, double time_s) {
                const double way_m = std::fmod(time_s, 0.1) < 0.05 ? -kJerkM : kJerkM;
                return std::vector<Pose>{
                    moved(rest[0], {0, 0, way_m}, Eigen::AngleAxisd(0, Eigen::Vector3d::UnitZ()))};
            },
            kLongDtS, kSteps, config);
    };
    const Difference d = difference(run(10), run(1), 0);
    // Turns of 1e-3 at most.
    constexpr double kNonlinear = 1e-4;
    EXPECT_GT(d.largest_force_n, 1e-3);
    EXPECT_LT(d.force, kNonlinear) << text(d);
}

}  // namespace
}  // namespace knead::test
