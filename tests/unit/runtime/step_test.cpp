// SPDX-License-Identifier: Apache-2.0
#include "core/step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "unit/runtime/press.h"

namespace knead::test {
namespace {

using core::Field;
using core::Vec;

/// Equilibrium of the 22 kPa cube (n = 6) pressed by 10 % without slip: two independent programs agree on all
/// digits.
constexpr double kPressedCube_n = 23.82645;
/// Half a unit of the last digit of that number, and as much for the solver.
constexpr double kPressedCubeTolerance_n = 1e-5;

Vec to_vec(const Vec3& v) {
    return {v[0], v[1], v[2]};
}

Asset pressed_cube(std::uint32_t n = 6) {
    return cube_asset(n, ToolShape::plate, ToolContact::bonded);
}

/// A body that nothing holds, with a tool that is far away.
Asset free_block() {
    TetMesh mesh = kuhn_box(3, 2, 2, {0.06, 0.04, 0.04});
    jitter(mesh, 0.02, 0.1, 2);
    Asset asset = asset_of(mesh, [](const Point&) { return false; });
    ToolSet tool;
    tool.name = "far";
    tool.contact = ToolContact::frictionless;
    tool.rest_position_m = {0, 0, 10};
    tool.nodes = {0, 1, 2};
    asset.tools = {tool};
    return asset;
}

double largest_distance(const Field& a, const Field& b) {
    double result = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        result = std::max(result, (a[i] - b[i]).norm());
    return result;
}

TEST(Step, of_the_pressed_cube_settles_at_the_equilibrium_force) {
    const Asset asset = pressed_cube();
    Stepper stepper(asset, precise());
    const StepResult result = settle(stepper, asset, {0, 0, -0.01});
    EXPECT_EQ(result.status, kStepOk);
    EXPECT_NEAR(result.force_n[2], kPressedCube_n, kPressedCubeTolerance_n);
    EXPECT_EQ(result.touched_nodes, 49u);
}

/// Cells of `contrast` times the elasticity in a soft cube, which share no node with one another nor with the
/// border: the force is small against the rounding of their rows.
Asset islands(double contrast) {
    constexpr std::uint32_t n = 6;
    Asset asset = pressed_cube(n);
    asset.palette = {{4e3, 0.49, 1000}, {contrast * 4e3, 0.49, 1000}};
    for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
        Vec middle = Vec::Zero();
        for (const std::uint32_t node : asset.tetrahedra[t])
            middle += to_vec(asset.nodes_m[node]) / 4;
        const Eigen::Vector3i cell = (middle * (n / 0.1)).cast<int>();
        asset.palette_index[t] = (cell.array() == 1 || cell.array() == 3).all() ? 1 : 0;
    }
    return asset;
}

/// Forces of a press with a twist of the tool, in long steps: islands turn.
std::vector<Vec> forces_in(const Asset& asset, Arithmetic arithmetic, double dt_s, double force_tolerance) {
    SimulationConfig config;
    config.arithmetic = arithmetic;
    config.expected_dt_s = dt_s;
    config.force_tolerance = force_tolerance;
    Stepper stepper(asset, config);
    std::vector<Vec> forces;
    for (int i = 1; i <= 30; ++i) {
        const double share = std::min(1.0, i / 20.0);
        Pose pose = moved(asset, {0.003 * share, 0, -0.02 * share});
        const auto& o = asset.tools[0].rest_orientation_wxyz;
        const Eigen::Quaterniond turned = Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * share, Vec::UnitZ())) *
                                          Eigen::Quaterniond(o[0], o[1], o[2], o[3]);
        pose.orientation_wxyz = {turned.w(), turned.x(), turned.y(), turned.z()};
        const StepResult result = stepper.step(pose, dt_s);
        EXPECT_EQ(result.status, kStepOk) << "step " << i;
        forces.push_back(to_vec(result.force_n));
    }
    return forces;
}

double largest_relative_difference(const std::vector<Vec>& a, const std::vector<Vec>& exact) {
    double result = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        result = std::max(result, (a[i] - exact[i]).norm() / exact[i].norm());
    return result;
}

TEST(Step, in_mixed_arithmetic_is_right_where_single_precision_is_not) {
    // The rounding of the solve, which no tolerance makes smaller: measured from 0.7e-4 to 3.2e-4, as the
    // compiler and the instruction set fuse multiplications with additions or not.
    constexpr double kMixedError = 4e-4;
    constexpr double kSinglesShare = 1.5;  // measured: 5
    const Asset asset = islands(1e6);
    for (const double dt_s : {10e-3, 1e-3}) {
        const auto exact = forces_in(asset, Arithmetic::float64, dt_s, 1e-6);
        EXPECT_LT(largest_relative_difference(forces_in(asset, Arithmetic::mixed, dt_s, 1e-4), exact),
                  kMixedError)
            << dt_s;
    }
    const double dt_s = 10e-3;
    const auto exact = forces_in(asset, Arithmetic::float64, dt_s, 1e-6);
    EXPECT_GT(
        largest_relative_difference(forces_in(asset, Arithmetic::float32, dt_s, 1e-4), exact),
        kSinglesShare * largest_relative_difference(forces_in(asset, Arithmetic::mixed, dt_s, 1e-4), exact))
        << "or the case shows nothing";
}

TEST(Step, with_the_default_tolerance_settles_within_a_thousandth) {
    const Asset asset = pressed_cube();
    Stepper stepper(asset, {});
    for (int i = 0; i < 600; ++i)
        (void)stepper.step(moved(asset, {0, 0, -0.01 * std::min(1.0, i / 300.0)}), 1e-3);
    StepResult result;
    for (int i = 0; i < 1500; ++i)
        result = stepper.step(moved(asset, {0, 0, -0.01}), 1e-3);
    EXPECT_NEAR(result.force_n[2], kPressedCube_n, 1e-3 * kPressedCube_n);
}

TEST(Step, of_a_stretched_column_without_poisson_effect_gives_the_analytic_force) {
    Asset asset = cube_asset(4, ToolShape::plate, ToolContact::bonded, {22e3, 0.0, 1000});
    for (std::uint32_t i = 0; i < asset.free_node_count; ++i) {  // an irregular inside
        for (double& c : asset.nodes_m[i]) {
            if (c > 0.01 && c < 0.09) c += 0.002 * std::sin(1e4 * c + i);
        }
    }
    Stepper stepper(asset, precise());
    const StepResult result = settle(stepper, asset, {0, 0, 0.015});
    const Field positions = stepper.positions_m();
    EXPECT_NEAR(result.force_n[2], -22e3 * 0.1 * 0.1 * 0.15, 1e-7 * 33);
    for (std::size_t i = 0; i < asset.nodes_m.size(); ++i) {
        EXPECT_NEAR(positions[i].z(), 1.15 * asset.nodes_m[i][2], 1e-9);
        EXPECT_NEAR(positions[i].x(), asset.nodes_m[i][0], 1e-9);
    }
}

TEST(Step, of_a_turned_tool_carries_its_nodes_rigidly) {
    const Asset asset = pressed_cube(3);
    Stepper stepper(asset, precise());
    const double angle = 0.4;
    Pose pose = moved(asset, {0.001, 0.002, 0.003});
    StepResult result;
    for (int i = 1; i <= 100; ++i) {
        const double share = std::min(1.0, i / 50.0);
        pose.orientation_wxyz = {std::cos(share * angle / 2), 0, 0, std::sin(share * angle / 2)};
        result = stepper.step(pose, 20e-3);
    }
    EXPECT_EQ(result.status, kStepOk);
    const Eigen::AngleAxisd turn(angle, Vec::UnitZ());
    for (const auto node : asset.tools[0].nodes) {
        const Vec expected = to_vec(pose.position_m) +
                             turn * (to_vec(asset.nodes_m[node]) - to_vec(asset.tools[0].rest_position_m));
        EXPECT_LT((stepper.positions_m()[node] - expected).norm(), 1e-12);
    }
}

TEST(Step, at_rest_changes_nothing) {
    const Asset asset = pressed_cube();
    Stepper stepper(asset, {});
    StepResult result;
    for (int i = 0; i < 100; ++i)
        result = stepper.step(moved(asset, {}), 1e-3);
    EXPECT_LT(to_vec(result.force_n).norm(), 1e-10);
    EXPECT_LT(largest_distance(stepper.positions_m(), stepper.rest_m()), 1e-15);
}

TEST(Step, of_a_free_body_under_gravity_falls_without_deforming) {
    Asset asset = free_block();
    asset.gravity_m_per_s2 = {1, -2, -9.81};
    Stepper stepper(asset, precise());
    const int steps = 200;
    const double dt = 1e-3;
    for (int i = 0; i < steps; ++i)
        EXPECT_EQ(stepper.step(moved(asset, {}), dt).status, kStepOk);
    // Implicit Euler: x = g dt^2 n (n + 1) / 2, exactly.
    const Vec fallen = to_vec(asset.gravity_m_per_s2) * dt * dt * steps * (steps + 1) / 2.0;
    for (std::size_t i = 0; i < asset.nodes_m.size(); ++i) {
        EXPECT_LT((stepper.positions_m()[i] - stepper.rest_m()[i] - fallen).norm(), 1e-9);
    }
}

TEST(Step, of_a_damped_free_body_under_gravity_reaches_the_terminal_velocity) {
    Asset asset = free_block();
    asset.gravity_m_per_s2 = {0, 0, -9.81};
    asset.damping_per_s = 50;
    Stepper stepper(asset, precise());
    for (int i = 0; i < 1000; ++i)
        (void)stepper.step(moved(asset, {0, 0, 1}), 1e-3);
    for (const Vec& v : stepper.velocities_m_per_s())
        EXPECT_LT((v - Vec(0, 0, -9.81 / 50)).norm(), 1e-6);
}

/// Throws the free block by letting the plate hit it from above, then takes the plate away.
void hit(Stepper& stepper, const Asset& asset) {
    for (int i = 0; i < 20; ++i)
        (void)stepper.step(moved(asset, {0, 0, -0.001 * i}), 1e-3);
    (void)stepper.step(moved(asset, {0, 0, 1}), 1e-3);
}

TEST(Step, of_a_free_vibrating_body_conserves_momentum) {
    Asset asset = free_block();
    asset.tools[0].rest_position_m = {0.01, 0, 0.045};
    asset.tools[0].nodes = free_nodes(asset, [](const Point& p) { return p[2] > 0.03 && p[0] < 0.03; });
    Stepper stepper(asset, precise());
    hit(stepper, asset);
    const Vec before = flight_of(stepper).momentum;
    ASSERT_GT(before.norm(), 1e-4);
    for (int i = 0; i < 300; ++i)
        EXPECT_EQ(stepper.step(moved(asset, {0, 0, 1}), 1e-3).touched_nodes, 0u);
    EXPECT_LT((flight_of(stepper).momentum - before).norm(), 1e-6 * before.norm());
}

TEST(Step, of_a_stiff_free_body_conserves_momentum_at_the_default_tolerance) {
    constexpr double kMomentum = 1e-4;  // ten times what float32 makes of 1000 steps
    Asset asset = free_block();
    asset.palette[0].youngs_modulus_pa = 1e9;
    asset.tools[0].rest_position_m = {0.01, 0, 0.045};
    asset.tools[0].nodes = free_nodes(asset, [](const Point& p) { return p[2] > 0.03 && p[0] < 0.03; });
    Stepper stepper(asset, {});
    for (int i = 0; i < 100; ++i)
        (void)stepper.step(moved(asset, {0, 0, -0.0003 * i}), 1e-3);
    (void)stepper.step(moved(asset, {0, 0, 1}), 1e-3);
    const Vec before = flight_of(stepper).momentum;
    ASSERT_GT(before.norm(), 1e-2);  // 0.1 m/s
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
        EXPECT_EQ(stepper.step(moved(asset, {0, 0, 1}), 1e-3).status, kStepOk);
        worst = std::max(worst, (flight_of(stepper).momentum - before).norm());
    }
    EXPECT_LT(worst, kMomentum * before.norm());
}

TEST(Step, of_a_stiff_free_body_keeps_its_spin_but_for_what_implicit_euler_takes) {
    constexpr double kSpin = 1e-3, kDt = 1e-3;
    for (const double damping_per_s : {0.0, 2.0}) {
        for (const double youngs_modulus_pa : {1e6, 1e8, 1e9}) {
            Asset asset = free_block();
            asset.damping_per_s = damping_per_s;
            asset.palette[0].youngs_modulus_pa = youngs_modulus_pa;
            asset.tools[0].rest_position_m = {0.01, 0, 0.045};
            asset.tools[0].nodes =
                free_nodes(asset, [](const Point& p) { return p[2] > 0.03 && p[0] < 0.03; });
            Stepper stepper(asset, {});
            for (int i = 0; i < 100; ++i)
                (void)stepper.step(moved(asset, {0, 0, -0.0003 * i}), kDt);
            (void)stepper.step(moved(asset, {0, 0, 1}), kDt);
            Vec expected = flight_of(stepper).spin;
            const double before = expected.norm();
            ASSERT_GT(before, 1e-5);
            for (int i = 0; i < 500; ++i) {
                const Field v0 = stepper.velocities_m_per_s();
                (void)stepper.step(moved(asset, {0, 0, 1}), kDt);
                expected += spin_of_implicit_euler(stepper, v0, kDt);
                expected -= (damping_per_s * kDt) * flight_of(stepper).spin;
            }
            EXPECT_LT((flight_of(stepper).spin - expected).norm(), kSpin * before) << youngs_modulus_pa;
        }
    }
}

TEST(Step, with_a_pose_that_is_not_valid_gives_zero_force_and_keeps_the_state) {
    const Asset asset = pressed_cube(3);
    Stepper stepper(asset, {});
    (void)settle(stepper, asset, {0, 0, -0.01}, 20, 10);
    const Field before = stepper.positions_m();
    const double nan = std::nan("");
    const double infinity = std::numeric_limits<double>::infinity();
    Pose bad_position = moved(asset, {nan, 0, 0});
    Pose far_away = moved(asset, {0, -infinity, 0});
    Pose bad_turn = moved(asset, {});
    bad_turn.orientation_wxyz = {nan, 0, 0, 0};
    Pose not_unit = moved(asset, {});
    not_unit.orientation_wxyz = {2, 0, 0, 0};
    Pose zero_turn = moved(asset, {});
    zero_turn.orientation_wxyz = {0, 0, 0, 0};
    for (const Pose& pose : {bad_position, far_away, bad_turn, not_unit, zero_turn}) {
        const StepResult result = stepper.step(pose, 1e-3);
        EXPECT_EQ(result.status, kStepBadInput);
        EXPECT_EQ(result.force_n, Vec3{});
        EXPECT_EQ(largest_distance(stepper.positions_m(), before), 0);
    }
    EXPECT_EQ(stepper.step(moved(asset, {0, 0, -0.01}), 1e-3).status, kStepOk);
}

TEST(Step, with_a_dt_out_of_range_is_refused) {
    const Asset asset = pressed_cube(2);
    Stepper stepper(asset, {});
    for (const double dt :
         {0.0, -1e-3, 0.24e-3, 21e-3, std::nan(""), std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(stepper.step(moved(asset, {}), dt).status, kStepBadInput) << dt;
    }
    for (const double dt : {0.25e-3, 1.0 / 4000, 20e-3, 1.0 / 50}) {
        EXPECT_EQ(stepper.step(moved(asset, {}), dt).status, kStepOk) << dt;
    }
}

TEST(Step, that_would_leave_the_finite_numbers_gives_zero_force_and_keeps_the_state) {
    const Asset asset = cube_asset(2, ToolShape::plate, ToolContact::sticking);
    Stepper stepper(asset, {});
    (void)settle(stepper, asset, {0, 0, -0.01}, 20, 10);
    const Field before = stepper.positions_m();
    const StepResult result = stepper.step(moved(asset, {1e306, 0, 0}), 1e-3);
    EXPECT_TRUE(result.status & kStepNotFinite) << result.status;
    EXPECT_EQ(result.force_n, Vec3{});
    EXPECT_EQ(largest_distance(stepper.positions_m(), before), 0);
    const StepResult next = stepper.step(moved(asset, {0, 0, -0.01}), 1e-3);
    EXPECT_EQ(next.status, kStepOk);
    EXPECT_GT(next.force_n[2], 1);
}

TEST(Step, with_a_bonded_tool_farther_away_than_the_numbers_reach_is_refused) {
    const Asset asset = pressed_cube(2);
    const double size_m = 0.1 * std::sqrt(3.0);
    Stepper stepper(asset, {});
    for (const double way_m : {1.01e4 * size_m, 1e10, 1e306})
        EXPECT_EQ(stepper.step(moved(asset, {0, -way_m, 0}), 1e-3).status, kStepBadInput) << way_m;
    EXPECT_EQ(stepper.step(moved(asset, {0, -0.99e4 * size_m, 0}), 1e-3).status, kStepOk);
    // What carries nothing may be anywhere.
    const Asset touched = cube_asset(2, ToolShape::plate, ToolContact::frictionless);
    Stepper far(touched, {});
    EXPECT_EQ(far.step(moved(touched, {0, 0, 1e10}), 1e-3).status, kStepOk);
}

TEST(Step, through_matter_that_is_inside_out_says_so_until_it_is_right_again) {
    const Asset asset = pressed_cube(3);
    Stepper stepper(asset, {});
    EXPECT_EQ(stepper.step(moved(asset, {0, 0, -0.01}), 1e-3).status, kStepOk);
    const StepResult pushed_through = stepper.step(moved(asset, {0, 0, -0.15}), 1e-3);
    EXPECT_EQ(pushed_through.status, kStepInsideOut);
    EXPECT_GT(pushed_through.force_n[2], 0);
    for (int k = 0; k < 2000; ++k)
        (void)stepper.step(moved(asset, {0, 0, -0.01}), 1e-3);
    EXPECT_EQ(stepper.step(moved(asset, {0, 0, -0.01}), 1e-3).status, kStepOk);
}

TEST(Step, at_its_iteration_cap_says_so_and_stops_the_free_nodes) {
    const Asset asset = pressed_cube();
    SimulationConfig config;
    config.max_solver_iterations = 2;
    Stepper stepper(asset, config);
    const StepResult result = stepper.step(moved(asset, {0, 0, -0.005}), 20e-3);
    EXPECT_EQ(result.status, kStepNotConverged);
    EXPECT_EQ(result.solver_iterations, 2u);
    EXPECT_TRUE(std::isfinite(result.force_n[2]));
    const Field velocities = stepper.velocities_m_per_s();
    for (std::uint32_t i = 0; i < velocities.size(); ++i) {
        const bool carried = std::binary_search(asset.tools[0].nodes.begin(), asset.tools[0].nodes.end(), i);
        EXPECT_EQ(velocities[i].norm() > 0, carried) << "node " << i;
    }
}

TEST(Step, repeated_with_the_same_inputs_gives_the_same_bits) {
    Asset asset = cube_asset(4, ToolShape::sphere, ToolContact::sticking);
    make_heterogeneous(asset, 3);
    Stepper first(asset, {}), second(asset, {});
    const auto pose = [&](int i) {
        return moved(asset, {0.002 * std::sin(0.1 * i), 0, -0.01 * std::sin(0.03 * i)});
    };
    std::vector<Vec3> forces;
    for (int i = 0; i < 150; ++i)
        forces.push_back(first.step(pose(i), 1e-3 * (1 + i % 3)).force_n);
    for (int i = 0; i < 40; ++i)
        (void)second.step(pose(2 * i), 2e-3);
    second.reset();
    for (int i = 0; i < 150; ++i) {
        const Vec3 again = second.step(pose(i), 1e-3 * (1 + i % 3)).force_n;
        ASSERT_EQ(std::memcmp(&again, &forces[static_cast<std::size_t>(i)], sizeof again), 0) << "step " << i;
    }
}

/// The same body with free nodes and tetrahedra in another order.
Asset shuffled(const Asset& asset, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::vector<std::uint32_t> order(asset.free_node_count);
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = order.size() - 1; i > 0; --i)
        std::swap(order[i], order[engine() % (i + 1)]);
    Asset result = asset;
    for (std::uint32_t i = 0; i < order.size(); ++i)
        result.nodes_m[order[i]] = asset.nodes_m[i];
    const auto renumber = [&](std::uint32_t& node) {
        if (node < order.size()) node = order[node];
    };
    for (Tetrahedron& t : result.tetrahedra) {
        for (std::uint32_t& node : t)
            renumber(node);
        std::rotate(t.begin(), t.begin() + 1, t.begin() + 3);  // another first node, same orientation
    }
    for (std::size_t i = result.tetrahedra.size() - 1; i > 0; --i) {
        const std::size_t j = engine() % (i + 1);
        std::swap(result.tetrahedra[i], result.tetrahedra[j]);
        std::swap(result.palette_index[i], result.palette_index[j]);
    }
    for (std::uint32_t& node : result.tools[0].nodes)
        renumber(node);
    std::sort(result.tools[0].nodes.begin(), result.tools[0].nodes.end());
    return result;
}

TEST(Step, of_the_same_body_in_another_order_gives_the_same_force) {
    Asset asset = pressed_cube(4);
    make_heterogeneous(asset, 5);
    const Asset other = shuffled(asset, 8);
    Stepper a(asset, precise()), b(other, precise());
    for (int i = 1; i <= 60; ++i) {
        const Pose pose = moved(asset, {1e-4 * i, 0, -2e-4 * std::min(i, 40)});
        const Vec first = to_vec(a.step(pose, 2e-3).force_n), second = to_vec(b.step(pose, 2e-3).force_n);
        ASSERT_LT((first - second).norm(), 1e-6 * first.norm()) << "step " << i;
    }
}

TEST(Step, at_half_compression_stays_finite_and_the_body_recovers) {
    Asset asset = pressed_cube();
    make_heterogeneous(asset, 1);
    Stepper stepper(asset, {});
    std::uint32_t status = 0;
    int inverted = 0;
    for (int i = 1; i <= 2000; ++i) {
        const double depth = i <= 500   ? 0.05 * i / 500.0
                             : i <= 700 ? 0.05
                                        : std::max(0.0, 0.05 * (1200 - i) / 500.0);
        const StepResult result = stepper.step(moved(asset, {0, 0, -depth}), 2e-3);
        status |= result.status;
        ASSERT_TRUE(std::isfinite(result.force_n[2]));
        ASSERT_LT(std::abs(result.force_n[2]), 1000);
        if (i != 600) continue;
        for (const Tetrahedron& t : asset.tetrahedra) {
            const auto& x = stepper.positions_m();
            if ((x[t[1]] - x[t[0]]).dot((x[t[2]] - x[t[0]]).cross(x[t[3]] - x[t[0]])) < 0) ++inverted;
        }
    }
    EXPECT_GT(inverted, 0) << "not the hard case that this test is for";
    EXPECT_EQ(status & ~std::uint32_t{kStepNotConverged}, kStepInsideOut);
    EXPECT_LT(largest_distance(stepper.positions_m(), stepper.rest_m()), 1e-5);
}

}  // namespace
}  // namespace knead::test
