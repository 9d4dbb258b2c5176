// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "unit/runtime/press.h"

namespace knead::test {
namespace {

using core::Vec;

SimulationConfig coupled(double stiffness_n_per_m, double damping_n_s_per_m, double mass_kg = 0.05) {
    SimulationConfig config = precise();
    config.coupling_stiffness_n_per_m = stiffness_n_per_m;
    config.coupling_damping_n_s_per_m = damping_n_s_per_m;
    config.tool_mass_kg = mass_kg;
    return config;
}

class Coupling : public testing::TestWithParam<ToolContact> {};

TEST_P(Coupling, at_rest_balances_spring_and_object) {
    const Asset asset = cube_asset(4, ToolShape::plate, GetParam());
    const double stiffness = 1500;
    Stepper stepper(asset, coupled(stiffness, 2));
    const StepResult result = settle(stepper, asset, {0, 0, -0.01}, 50, 400);
    EXPECT_EQ(result.status, kStepOk);
    const double tool_z = result.tool_position_m[2] - 0.1;
    EXPECT_NEAR(result.force_n[2], stiffness * (tool_z + 0.01), 1e-6);
    // An uncoupled tool, put where the coupled one came to rest, feels the same force.
    Stepper direct(asset, precise());
    const Vec3& tool = result.tool_position_m;
    const StepResult expected = settle(direct, asset, {tool[0] - 0.05, tool[1] - 0.05, tool_z}, 50, 400);
    EXPECT_GT(expected.force_n[2], 5);
    const double tolerance = GetParam() == ToolContact::sticking ? 1e-3 : 1e-6;  // sticking remembers its way
    EXPECT_NEAR(result.force_n[2], expected.force_n[2], tolerance * expected.force_n[2]);
}

INSTANTIATE_TEST_SUITE_P(Contacts, Coupling,
                         testing::Values(ToolContact::bonded, ToolContact::sticking,
                                         ToolContact::frictionless));

TEST(CoupledTool, that_slides_with_friction_is_in_balance_with_what_it_touches) {
    const Asset asset = cube_asset(4, ToolShape::plate, ToolContact::coulomb);
    SimulationConfig config = coupled(1500, 2);
    config.force_tolerance = 1e-5;
    config.max_contact_passes = 40;
    Stepper stepper(asset, config);
    for (int i = 1; i <= 2000; ++i) {
        const double x = 0.03 * std::max(0, i - 500) * 1e-3;
        const StepResult result = stepper.step(moved(asset, {x, 0, -0.012 * std::min(1.0, i / 500.0)}), 1e-3);
        ASSERT_EQ(result.status, kStepOk) << "step " << i;
    }
    const StepResult result = stepper.step(moved(asset, {0.03 * 1.501, 0, -0.012}), 1e-3);
    EXPECT_GT(result.force_n[2], 5);
    // Steady but for the inertia of the tool: the spring carries what friction and the normal force carry.
    EXPECT_NEAR(result.force_n[0], -0.4 * result.force_n[2], 1e-3 * result.force_n[2]);
    EXPECT_NEAR(result.force_n[1], 0, 1e-3 * result.force_n[2]);
}

TEST(CoupledTool, away_from_the_object_is_a_damped_oscillator_of_implicit_euler) {
    const Asset asset = cube_asset(2, ToolShape::plate, ToolContact::sticking);
    const double k = 400, c = 1.5, m = 0.1, dt = 1e-3;
    Stepper stepper(asset, coupled(k, c, m));
    double x = 0, v = 0, hand_before = 0;
    for (int i = 1; i <= 300; ++i) {
        const double hand = 0.02 + 0.01 * std::sin(0.02 * i);
        const double hand_speed = (hand - hand_before) / dt;
        // m (v' - v) / dt = -k (x + dt v' - hand) - c (v' - hand_speed), by hand
        v = (m * v / dt - k * (x - hand) + c * hand_speed) / (m / dt + dt * k + c);
        x += dt * v;
        hand_before = hand;
        const StepResult result = stepper.step(moved(asset, {0, 0, hand}), dt);
        ASSERT_NEAR(result.tool_position_m[2] - 0.1, x, 1e-12);
        ASSERT_NEAR(result.force_n[2], k * (x - hand) + c * (v - hand_speed), 1e-9);
        ASSERT_EQ(result.touched_nodes, 0u);
    }
}

TEST(CoupledTool, that_is_light_and_held_hard_stays_stable) {
    Asset asset = cube_asset(4, ToolShape::plate, ToolContact::bonded);
    make_heterogeneous(asset, 2);
    for (const double dt : {0.25e-3, 1e-3, 20e-3}) {
        Stepper stepper(asset, coupled(1e5, 0, 1e-4));  // a mass far below that of the nodes it carries
        StepResult result;
        for (int i = 0; i < 400; ++i)
            result = stepper.step(moved(asset, {0, 0, -0.005}), dt);
        EXPECT_EQ(result.status, kStepOk);
        EXPECT_LT(std::abs(result.tool_position_m[2] - 0.095), 1e-3);
        EXPECT_LT(result.force_n[2], 30);
    }
}

}  // namespace
}  // namespace knead::test
