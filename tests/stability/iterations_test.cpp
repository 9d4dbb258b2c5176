// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <ostream>
#include <random>
#include <string>

#include "stability/contact_scene.h"

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

Simulation simulation_of(const Asset& asset, double expected_dt_s) {
    SimulationConfig config;
    config.expected_dt_s = expected_dt_s;
    Result<Simulation> created = Simulation::create(asset, config);
    if (!created.ok()) throw std::runtime_error(created.error().text());
    return std::move(created).value();
}

/// Down by a tenth in a fifth of a second, with a hand's tremor (10 Hz, 0.3 mm, a third of it sideways).
Pose pressed(const Pose& rest, double time_s) {
    constexpr double kWayM = 0.1 * kCubeSideM;
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

// Wanted: within 10 % of a factor made for the touched set, and steps take whole iterations.
constexpr double kMoreIterations = 1.1;

TEST_P(IterationsInContact, Are_those_of_a_run_in_which_the_same_nodes_are_eliminated) {
    const auto [cells, nu, dt_s] = GetParam();
    const int steps = static_cast<int>(std::lround(0.3 / dt_s));
    Simulation touching = simulation_of(held_in_the_middle(cells, nu, ToolContact::sticking), dt_s);
    Simulation bonded = simulation_of(held_in_the_middle(cells, nu, ToolContact::bonded), dt_s);
    const Pose rest = touching.tool_rest_pose();
    Iterations with_contact, eliminated, all;
    std::uint32_t nodes = 0;
    for (int k = 1; k <= steps; ++k) {
        const Pose pose = pressed(rest, k * dt_s);
        const StepResult a = touching.step(pose, dt_s);
        const StepResult b = bonded.step(pose, dt_s);
        all.add(a);
        nodes = std::max(nodes, a.touched_nodes);
        if (a.touched_nodes != b.touched_nodes) continue;
        with_contact.add(a);
        eliminated.add(b);
    }
    std::printf("n %u nu %.2f dt %.0f ms: %d nodes; %d of %d steps alike; iterations %.2f (max %u) bonded %.2f (max %u); all %.2f (max %u) status %u\n", cells, nu,
                1e3 * dt_s, nodes, with_contact.steps, steps, with_contact.mean(), with_contact.largest, eliminated.mean(),
                eliminated.largest, all.mean(), all.largest, all.status);
    EXPECT_LE(with_contact.mean(), kMoreIterations * eliminated.mean());
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

TEST(IterationsUnderAnotherDt, Jitter) {
    for (const double nu : {0.3, 0.49}) {
        for (const double dt_s : {1e-3, 10e-3}) {
            const Asset asset = held_in_the_middle(6, nu, ToolContact::bonded);
            Simulation steady = simulation_of(asset, dt_s), jittering = simulation_of(asset, dt_s);
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
            std::printf("jitter nu %.2f dt %.0f ms: steady %.2f (max %u), jittering %.2f (max %u) status %u\n", nu, 1e3 * dt_s, a.mean(),
                        a.largest, b.mean(), b.largest, b.status);
        }
    }
}

TEST(IterationsUnderAnotherDt, Jumps) {
    for (const std::uint32_t cells : {6U, 10U})
    for (const double nu : {0.3, 0.49}) {
        const Asset asset = held_in_the_middle(cells, nu, ToolContact::sticking);
        Simulation simulation = simulation_of(asset, 0.25e-3);
        const Pose rest = simulation.tool_rest_pose();
        double time_s = 0;
        for (const double dt_s : {0.25e-3, 20e-3, 1e-3, 0.25e-3}) {
            const int steps = dt_s < 0.5e-3 ? 400 : dt_s < 5e-3 ? 400 : 60;
            std::vector<std::uint32_t> its;
            Iterations late;
            std::uint32_t status = 0;
            for (int k = 0; k < steps; ++k) {
                time_s += dt_s;
                const StepResult r = simulation.step(pressed(rest, time_s), dt_s);
                status |= r.status;
                its.push_back(r.solver_iterations);
                if (k >= steps * 3 / 4) late.add(r);
            }
            int last = 0;
            std::uint32_t most = 0;
            for (int k = 0; k < steps; ++k) {
                most = std::max(most, its[size_t(k)]);
                if (its[size_t(k)] > late.largest) last = k + 1;
            }
            std::printf("n %u nu %.2f to dt %.2f ms: max %u iterations, late mean %.2f max %u; last above at step %d; status %u; first:", cells, nu, 1e3 * dt_s, most, late.mean(), late.largest, last, status);
            for (int k = 0; k < 30; ++k) std::printf(" %u", its[size_t(k)]);
            std::printf("\n");
        }
    }
}

}  // namespace
}  // namespace knead::test
