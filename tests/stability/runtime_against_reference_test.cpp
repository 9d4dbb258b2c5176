// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "stability/press_asset.h"
#include "stability/scenario_press.h"
#include "support/simulation_of.h"

namespace knead {
namespace {

// What the issue asks for; the runtime aims at a force error of 1e-4 in each step.
constexpr double kForceTolerance = 1e-3;
// A thousandth of the plate's way, for the same reason.
constexpr double kPositionTolerance = 1e-3;

// The longest step of the runtime: implicit Euler damps the most there, and only the end state is compared.
constexpr double kDtS = 20e-3;
constexpr int kRampSteps = 25;
constexpr int kLargestHoldSteps = 500;
// Static: no node moves more than this in a step, 1e-6 of the cube's side in a second.
constexpr double kStillMPerStep = 1e-6 * test::kCubeSideM * kDtS;

/// Where the runtime comes to rest under the plate.
struct Rest {
    Vec3 force_n{};
    std::uint32_t status = kStepOk;  ///< bits of all steps
    bool is_still = false;
};

double largest_change_m(const double* positions_m, std::vector<double>& before_m) {
    double largest = 0;
    for (std::size_t k = 0; k < before_m.size(); ++k) {
        largest = std::max(largest, std::abs(positions_m[k] - before_m[k]));
        before_m[k] = positions_m[k];
    }
    return largest;
}

Rest press_and_hold(Simulation& simulation, double way_m) {
    Rest rest;
    Pose pose = simulation.tool_rest_pose();
    const double start_m = pose.position_m[2];
    std::vector<double> before_m(3 * simulation.node_count());
    for (int k = 1; k <= kRampSteps + kLargestHoldSteps && !rest.is_still; ++k) {
        pose.position_m[2] = start_m - way_m * std::min(1.0, static_cast<double>(k) / kRampSteps);
        const StepResult step = simulation.step(pose, kDtS);
        rest.force_n = step.force_n;
        rest.status |= step.status;
        const double moved_m = largest_change_m(simulation.positions_m(), before_m);
        rest.is_still = k > kRampSteps && moved_m < kStillMPerStep;
    }
    return rest;
}

class RuntimeAgainstReference : public testing::TestWithParam<test::ScenarioPress> {};

TEST_P(RuntimeAgainstReference, Press_held_until_static_gives_the_force_and_shape_of_the_reference) {
    const test::PressedCube cube(GetParam());
    const tools::StaticSolution reference =
        tools::StaticProblem(cube.mesh, cube.material).solve(cube.press.motion);
    const Point expected_n = tools::force_on_plate_n(cube.press, reference);

    const test::PressAsset made = test::press_asset(cube);
    Simulation simulation = test::simulation_of(made.asset);
    const Rest rest = press_and_hold(simulation, cube.way_m());

    EXPECT_TRUE(rest.is_still);
    EXPECT_EQ(rest.status, kStepOk);
    const double size_n = std::hypot(expected_n[0], expected_n[1], expected_n[2]);
    for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(rest.force_n[axis], expected_n[axis], kForceTolerance * size_n);
    double largest_m = 0;
    for (std::size_t n = 0; n < made.mesh_node.size(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            largest_m = std::max(largest_m, std::abs(simulation.positions_m()[3 * n + axis] -
                                                     reference.positions_m[made.mesh_node[n]][axis]));
    EXPECT_LT(largest_m, kPositionTolerance * cube.way_m());
    RecordProperty("force_error", testing::PrintToString(rest.force_n[2] / expected_n[2] - 1));
    RecordProperty("position_error", testing::PrintToString(largest_m / cube.way_m()));
}

INSTANTIATE_TEST_SUITE_P(Press, RuntimeAgainstReference, testing::ValuesIn(test::scenario_presses(6, 10)),
                         [](const auto& press) { return test::name_of(press.param); });

}  // namespace
}  // namespace knead
