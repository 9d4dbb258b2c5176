// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>

#include "stability/contact_scene.h"
#include "support/simulation_of.h"

namespace knead::test {
namespace {

/// Iterations of the conjugate gradients over a stretch of steps.
struct Iterations {
    int steps = 0;
    long sum = 0;
    std::uint32_t largest = 0;
    std::uint32_t status = kStepOk;

    void add(const StepResult& result) {
        ++steps;
        sum += result.solver_iterations;
        largest = std::max(largest, result.solver_iterations);
        status |= result.status;
    }
    [[nodiscard]] double mean() const { return static_cast<double>(sum) / steps; }
};

Simulation simulation_for(const Asset& asset, double expected_dt_s, double force_tolerance = 3e-4) {
    SimulationConfig config;
    config.expected_dt_s = expected_dt_s;
    config.force_tolerance = force_tolerance;
    // Tighter than float32 can be sure of.
    if (force_tolerance < 1e-5) config.arithmetic = Arithmetic::float64;
    return simulation_of(asset, config);
}

constexpr int kPressSteps = 100;

/// Down by a tenth in a fifth of a second, with a hand's tremor (10 Hz, 0.3 mm, a third of it sideways).
Pose pressed(const Pose& rest, double time_s) {
    constexpr double kWayM = kPressStrain * kCubeSideM;
    constexpr double kRampS = 0.2;
    Pose pose = rest;
    pose.position_m[0] += 0.1e-3 * std::sin(2 * M_PI * 8.5 * time_s);
    pose.position_m[1] += 0.1e-3 * std::sin(2 * M_PI * 11.3 * time_s);
    pose.position_m[2] -= kWayM * std::min(1.0, time_s / kRampS) + 0.3e-3 * std::sin(2 * M_PI * 10 * time_s);
    return pose;
}

/// The tool holds the middle of the top face: bonded, or as a sticking plate that is as large.
Asset held_in_the_middle(std::uint32_t cells, double nu, ToolContact contact) {
    Asset asset = scenario_cube(cells, nu);
    ToolSet tool = tool_above(asset, ToolShape::plate, contact);
    const double half_m = 0.26 * kCubeSideM;
    std::vector<std::uint32_t> middle;
    for (const std::uint32_t n : tool.nodes) {
        const Point& x = asset.nodes_m[n];
        if (std::abs(x[0] - kCubeSideM / 2) <= half_m && std::abs(x[1] - kCubeSideM / 2) <= half_m)
            middle.push_back(n);
    }
    if (contact == ToolContact::bonded)
        tool.nodes = middle;
    else
        tool.half_extents_m = {half_m, half_m};
    asset.tools = {tool};
    return asset;
}

struct Case {
    std::uint32_t cells;
    double nu;
    double dt_s;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << "n = " << c.cells << ", nu " << c.nu << ", dt " << c.dt_s << " s";
}

class IterationsInContact : public testing::TestWithParam<Case> {};

// What the issue asks for, of the preconditioner; and what steps that take whole iterations add to it. At a
// tolerance where a step needs several: at the default many need one, and one more is 100 %.
constexpr double kMoreIterations = 1.1;
constexpr double kPartOfAnIteration = 0.25;
constexpr double kTightTolerance = 1e-7;
// The correction takes in sixteen nodes a solve: the 25 of the largest case, caught at once, soon are.
constexpr int kTakenIn = 3;
// Meanwhile held nodes are projected.
constexpr std::uint32_t kWhileTakenIn = 64;

TEST_P(IterationsInContact, Are_those_of_a_run_in_which_the_same_nodes_are_eliminated) {
    const auto [cells, nu, dt_s] = GetParam();
    Simulation touching =
        simulation_for(held_in_the_middle(cells, nu, ToolContact::sticking), dt_s, kTightTolerance);
    Simulation bonded =
        simulation_for(held_in_the_middle(cells, nu, ToolContact::bonded), dt_s, kTightTolerance);
    const Pose rest = touching.tool_rest_pose();
    Iterations with_contact, eliminated, first;
    for (int k = 1; k <= kPressSteps; ++k) {
        const Pose pose = pressed(rest, k * dt_s);
        const StepResult a = touching.step(pose, dt_s);
        const StepResult b = bonded.step(pose, dt_s);
        ASSERT_EQ(a.touched_nodes, b.touched_nodes) << "step " << k;
        (k <= kTakenIn ? first : with_contact).add(a);
        if (k > kTakenIn) eliminated.add(b);
    }
    EXPECT_EQ(first.status | with_contact.status | eliminated.status, kStepOk);
    EXPECT_LE(with_contact.mean(), kMoreIterations * eliminated.mean() + kPartOfAnIteration);
    EXPECT_LE(first.largest, kWhileTakenIn);
    RecordProperty("touching", testing::PrintToString(with_contact.mean()));
    RecordProperty("eliminated", testing::PrintToString(eliminated.mean()));
    RecordProperty("largest_while_caught", static_cast<int>(first.largest));
}

std::vector<Case> cases() {
    std::vector<Case> result;
    for (const std::uint32_t cells : {6U, 8U, 10U})
        for (const double nu : {0.3, 0.49})
            for (const double dt_s : {1e-3, 10e-3})
                result.push_back({cells, nu, dt_s});
    return result;
}

INSTANTIATE_TEST_SUITE_P(Plate, IterationsInContact, testing::ValuesIn(cases()));

/// Uniform in [0, 1), the same on every platform.
double draw(std::mt19937_64& engine) {
    return static_cast<double>(engine() >> 11U) * 0x1.0p-53;
}

// Jitter stays within what one set of numbers is good for. Measured: half an iteration more.
constexpr double kJitterIterations = 1;

TEST(IterationsUnderAnotherDt, Jitter_of_a_fifth_costs_less_than_an_iteration_a_step) {
    for (const double nu : {0.3, 0.49}) {
        for (const double dt_s : {1e-3, 10e-3}) {
            const Asset asset = held_in_the_middle(6, nu, ToolContact::bonded);
            Simulation steady = simulation_for(asset, dt_s);
            Simulation jittering = simulation_for(asset, dt_s);
            const Pose rest = steady.tool_rest_pose();
            std::mt19937_64 engine(1);
            Iterations a, b;
            double time_s = 0;
            for (int k = 1; k <= 400; ++k) {
                a.add(steady.step(pressed(rest, k * dt_s), dt_s));
                const double dt = dt_s * (0.8 + 0.4 * draw(engine));
                time_s += dt;
                b.add(jittering.step(pressed(rest, time_s), dt));
            }
            EXPECT_EQ(b.status, kStepOk);
            EXPECT_LE(b.mean(), a.mean() + kJitterIterations) << "nu " << nu << ", dt " << dt_s << " s";
            EXPECT_LE(b.largest, a.largest + 2) << "nu " << nu << ", dt " << dt_s << " s";
        }
    }
}

struct Jump {
    double dt_s;
    int steps;
    int latency;               ///< steps until iterations are back for good
    std::uint32_t iterations;  ///< of a step meanwhile
};
// Measured at nu .49, n = 6: 22 and 102 steps, 144 and 18 iterations.
constexpr Jump kJumps[] = {{0.25e-3, 100, 100, 3}, {20e-3, 60, 30, 180}, {1e-3, 300, 150, 30}};
// After that, of those of a simulation made for the dt. The states are not quite the same.
constexpr std::uint32_t kBack = 1;

TEST(IterationsUnderAnotherDt, Jump_from_a_quarter_to_twenty_to_one_millisecond_costs_bounded_work_and_ends) {
    for (const double nu : {0.3, 0.49}) {
        const Asset asset = held_in_the_middle(6, nu, ToolContact::sticking);
        Simulation jumping = simulation_for(asset, kJumps[0].dt_s);
        const Pose rest = jumping.tool_rest_pose();
        double time_s = 0;
        for (const Jump& jump : kJumps) {
            Simulation made_for_it = simulation_for(asset, jump.dt_s);
            Iterations meanwhile, back, expected;
            for (int k = 1; k <= jump.steps; ++k) {
                time_s += jump.dt_s;
                const Pose pose = pressed(rest, time_s);
                (k <= jump.latency ? meanwhile : back).add(jumping.step(pose, jump.dt_s));
                const StepResult result = made_for_it.step(pose, jump.dt_s);
                if (k > jump.latency) expected.add(result);
            }
            SCOPED_TRACE(testing::Message() << "nu " << nu << ", to " << jump.dt_s << " s");
            EXPECT_EQ(meanwhile.status | back.status, kStepOk);
            EXPECT_LE(meanwhile.largest, jump.iterations);
            if (back.steps > 0) {
                EXPECT_LE(back.largest, expected.largest + kBack);
            }
        }
    }
}

}  // namespace
}  // namespace knead::test
