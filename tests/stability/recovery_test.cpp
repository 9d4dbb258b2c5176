// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "reference/implicit_euler.h"
#include "stability/contact_scene.h"
#include "support/simulation_of.h"

namespace knead::test {
namespace {

constexpr double kDtS = 1e-3;

Eigen::Matrix3Xd positions(const Simulation& simulation) {
    return Eigen::Map<const Eigen::Matrix3Xd>(simulation.positions_m(), 3,
                                              static_cast<Eigen::Index>(simulation.node_count()));
}

Eigen::Matrix3Xd velocities(const Simulation& simulation) {
    Eigen::Matrix3Xd result(3, static_cast<Eigen::Index>(simulation.node_count()));
    simulation.velocities_m_per_s(result.data());
    return result;
}

int inverted_tetrahedra(const Asset& asset, const Eigen::Matrix3Xd& x) {
    int count = 0;
    for (const Tetrahedron& t : asset.tetrahedra) {
        const Eigen::Vector3d a = x.col(t[1]) - x.col(t[0]);
        const Eigen::Vector3d b = x.col(t[2]) - x.col(t[0]);
        const Eigen::Vector3d c = x.col(t[3]) - x.col(t[0]);
        if (a.cross(b).dot(c) < 0) ++count;
    }
    return count;
}

/// Root mean square distance from rest, over the side.
double off_rest(const Asset& asset, const Simulation& simulation) {
    const Eigen::Map<const Eigen::Matrix3Xd> rest(asset.nodes_m[0].data(), 3,
                                                  static_cast<Eigen::Index>(asset.nodes_m.size()));
    return (positions(simulation) - rest).norm() / std::sqrt(static_cast<double>(asset.nodes_m.size())) /
           kCubeSideM;
}

// What the issue asks for.
constexpr double kOffRest = 1e-4;
constexpr double kDampingPerS = 10;

struct Crush {
    std::uint32_t cells;
    ToolContact contact;
    double press_s;
};

void PrintTo(const Crush& crush, std::ostream* out) {
    *out << "n = " << crush.cells << ", contact " << static_cast<int>(crush.contact) << ", in "
         << crush.press_s << " s";
}

class Crushed : public testing::TestWithParam<Crush> {};

/// Down by half of the side, held for a tenth of a second, up again, then left alone.
TEST_P(Crushed, To_half_its_height_and_released_the_body_returns_to_its_rest_shape) {
    constexpr double kHoldS = 0.1;
    constexpr double kAloneS = 2;
    const auto [cells, contact, press_s] = GetParam();
    Asset asset = scenario_cube(cells);
    asset.tools = {tool_above(asset, ToolShape::plate, contact)};
    // Let go of, a body without damping swings for long: that is right, and no rest to compare with.
    if (contact != ToolContact::bonded) asset.damping_per_s = kDampingPerS;
    Simulation simulation = simulation_of(asset);
    const Pose rest = simulation.tool_rest_pose();
    const double end_s = 2 * press_s + kHoldS;
    int inverted = 0;
    int not_converged = 0;
    std::uint32_t other_status = 0;
    double largest_n = 0;
    for (int k = 1; k * kDtS <= end_s + kAloneS; ++k) {
        const double time_s = k * kDtS;
        const double depth = std::min(time_s / press_s, (end_s - time_s) / press_s);
        Pose pose = rest;
        pose.position_m[2] -= 0.5 * kCubeSideM * std::clamp(depth, 0.0, 1.0);
        if (time_s > end_s && contact != ToolContact::bonded) pose.position_m[2] += kCubeSideM;  // gone
        const StepResult result = simulation.step(pose, kDtS);
        ASSERT_TRUE(vec(result.force_n).allFinite()) << "step " << k;
        largest_n = std::max(largest_n, vec(result.force_n).norm());
        not_converged += (result.status & kStepNotConverged) != 0 ? 1 : 0;
        other_status |= result.status & ~std::uint32_t{kStepNotConverged};
        if (std::abs(time_s - press_s) < kDtS / 2)
            inverted = inverted_tetrahedra(asset, positions(simulation));
    }
    EXPECT_EQ(other_status, kStepInsideOut);
    EXPECT_GT(inverted, 0) << "not the hard case that this test is for";
    EXPECT_LT(off_rest(asset, simulation), kOffRest);
    RecordProperty("inverted", inverted);
    RecordProperty("steps_not_converged", not_converged);
    RecordProperty("off_rest", testing::PrintToString(off_rest(asset, simulation)));
    RecordProperty("largest_force_n", testing::PrintToString(largest_n));
}

INSTANTIATE_TEST_SUITE_P(
    Press, Crushed,
    testing::Values(Crush{6, ToolContact::bonded, 0.25}, Crush{6, ToolContact::bonded, 1},
                    Crush{8, ToolContact::bonded, 0.25}, Crush{6, ToolContact::sticking, 0.25},
                    Crush{6, ToolContact::frictionless, 0.25}, Crush{6, ToolContact::coulomb, 0.25}));

/// A block that nothing holds, hit off its middle by a ball, flies and turns.
struct Flight {
    Flight() {
        asset = scenario_cube(4);
        asset.free_node_count = static_cast<std::uint32_t>(asset.nodes_m.size());
        asset.tools = {tool_above(asset, ToolShape::sphere, ToolContact::frictionless)};
        asset.tools[0].rest_position_m[0] += 0.03;
        mass_kg.setZero(static_cast<Eigen::Index>(asset.nodes_m.size()));
        for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
            const Tetrahedron& n = asset.tetrahedra[t];
            const auto x = [&](int k) { return vec(asset.nodes_m[n[static_cast<std::size_t>(k)]]); };
            const double volume = Eigen::Vector3d(x(1) - x(0)).cross(x(2) - x(0)).dot(x(3) - x(0)) / 6;
            for (const std::uint32_t node : n)
                mass_kg[node] += asset.palette[asset.palette_index[t]].density_kg_per_m3 * volume / 4;
        }
    }
    [[nodiscard]] Eigen::Vector3d momentum(const Simulation& s) const { return velocities(s) * mass_kg; }
    /// About the centre of mass.
    [[nodiscard]] Eigen::Vector3d spin(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v) const {
        const Eigen::Vector3d middle = x * mass_kg / mass_kg.sum();
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (Eigen::Index i = 0; i < x.cols(); ++i)
            sum += mass_kg[i] * Eigen::Vector3d(x.col(i) - middle).cross(Eigen::Vector3d(v.col(i)));
        return sum;
    }
    [[nodiscard]] static Pose away(const Simulation& simulation) {
        Pose pose = simulation.tool_rest_pose();
        pose.position_m[2] += 10;
        return pose;
    }
    /// Pushes for 40 ms; what the ball gave, as its forces say.
    Eigen::Vector3d push(Simulation& simulation) const {
        Eigen::Vector3d impulse = Eigen::Vector3d::Zero();
        for (int k = 1; k <= 100; ++k) {
            Pose pose = simulation.tool_rest_pose();
            pose.position_m[2] -= 0.02 * ramp(k * kDtS, 0, 0.04) - 0.2 * ramp(k * kDtS, 0.04, 0.1);
            impulse -= kDtS * vec(simulation.step(pose, kDtS).force_n);
        }
        return impulse;
    }
    Asset asset;
    Eigen::VectorXd mass_kg;
};

// Unsolved parts of the steps, each at most 1e-4 m/s (root mean square) of the velocities, mostly while the
// body still vibrates: 2e-4 of the momentum.
constexpr double kMomentum = 1e-3;
// Implicit Euler slows a spin down, here by 1.4 % in the 200 steps; of that, linearised steps miss a tenth.
constexpr double kSpin = 3e-3;

TEST(FreeFlight, Conserves_the_momentum_that_the_tool_gave) {
    const Flight flight;
    Simulation simulation = simulation_of(flight.asset);
    const Eigen::Vector3d impulse = flight.push(simulation);
    ASSERT_GT(impulse.norm(), 0.1);
    EXPECT_LT((flight.momentum(simulation) - impulse).norm(), kMomentum * impulse.norm());
    const Pose away = flight.away(simulation);
    std::uint32_t status = kStepOk;
    for (int k = 1; k <= 2000; ++k) {
        const StepResult result = simulation.step(away, kDtS);
        status |= result.status;
        ASSERT_EQ(vec(result.force_n).norm(), 0);
    }
    EXPECT_EQ(status, kStepOk);
    EXPECT_LT((flight.momentum(simulation) - impulse).norm(), kMomentum * impulse.norm());
}

TEST(FreeFlight, Spins_as_in_converged_implicit_euler_steps) {
    const Flight flight;
    Simulation simulation = simulation_of(flight.asset);
    (void)flight.push(simulation);
    const ContactScene scene = scene_of(flight.asset);
    tools::ImplicitEuler reference(scene.mesh, scene.material);
    tools::MotionState state = reference.rest();
    const Eigen::Matrix3Xd x = positions(simulation);
    const Eigen::Matrix3Xd v = velocities(simulation);
    for (std::size_t i = 0; i < state.positions_m.size(); ++i) {
        const auto column = static_cast<Eigen::Index>(i);
        state.positions_m[i] = {x(0, column), x(1, column), x(2, column)};
        state.velocities_m_per_s[i] = {v(0, column), v(1, column), v(2, column)};
    }
    const Pose away = flight.away(simulation);
    const double start = flight.spin(x, v).norm();
    double largest = 0;
    for (int k = 1; k <= 200; ++k) {
        (void)simulation.step(away, kDtS);
        state = reference.step(state, {}, kDtS).state;
        const auto count = static_cast<Eigen::Index>(state.positions_m.size());
        const Eigen::Vector3d expected =
            flight.spin(Eigen::Map<const Eigen::Matrix3Xd>(state.positions_m[0].data(), 3, count),
                        Eigen::Map<const Eigen::Matrix3Xd>(state.velocities_m_per_s[0].data(), 3, count));
        const Eigen::Vector3d found = flight.spin(positions(simulation), velocities(simulation));
        largest = std::max(largest, (found - expected).norm());
    }
    EXPECT_LT(largest, kSpin * start);
    RecordProperty("spin_error", testing::PrintToString(largest / start));
}

}  // namespace
}  // namespace knead::test
