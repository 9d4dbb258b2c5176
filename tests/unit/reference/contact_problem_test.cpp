// SPDX-License-Identifier: Apache-2.0
#include "reference/contact_problem.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "common/error.h"
#include "reference/plate_press.h"
#include "unit/reference/contact_scene.h"

namespace knead::tools {
namespace {

using namespace contact_test;
using Eigen::Vector3d;
using test::uniform_material;

/// One tetrahedron on three held nodes, its fourth 0.1 m above the first.
struct OneTetrahedron {
    OneTetrahedron() {
        mesh.nodes_m = {{0, 0, 0}, {kSideM, 0, 0}, {0, kSideM, 0}, {0, 0, kSideM}};
        mesh.tetrahedra = {{0, 1, 2, 3}};
        held.nodes = {0, 1, 2};
        held.displacement_m.assign(3, Point{});
        tool.nodes = {3};
        tool.pose.position_m = {0, 0, kSideM};
    }
    TetMesh mesh;
    PrescribedMotion held;
    ContactTool tool;
};

TEST(ContactProblem, Plate_on_the_tip_of_one_tetrahedron_feels_stiffness_times_depth) {
    OneTetrahedron one;
    constexpr double kDepthM = 0.01;
    // Along z the gradient stays diagonal: P_zz = (2 mu + lambda) (F_zz - 1), force = V P_zz / height.
    const double modulus = kYoungsModulusPa * 0.7 / (1.3 * 0.4);
    const double stiffness = kSideM / 6 * modulus;
    ContactProblem problem(one.mesh, uniform_material(one.mesh, kYoungsModulusPa));
    one.tool.pose.position_m[2] -= kDepthM;
    for (const ToolContact law : {ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb}) {
        one.tool.law = law;
        const ContactSolution solution = problem.equilibrium(one.held, {one.tool});
        EXPECT_NEAR(solution.tools[0].force_n[2], stiffness * kDepthM, kTolerance);
        EXPECT_NEAR(solution.energy_j, stiffness * kDepthM * kDepthM / 2, kTolerance);
        EXPECT_EQ(solution.touching, 1u);
    }
    one.tool.pose.position_m[2] = kSideM + 1e-6;
    const ContactSolution apart = problem.equilibrium(one.held, {one.tool});
    EXPECT_EQ(apart.touching, 0u);
    EXPECT_EQ(vec(apart.tools[0].force_n).norm(), 0);
}

TEST(ContactProblem, Body_at_rest_with_a_tool_apart_or_at_its_surface_stays_at_rest_without_force) {
    const Scene scene(4);  // whose forces at rest are rounding, not zero
    ContactProblem problem(scene.mesh, scene.material);
    constexpr double kRoundingN = 1e-11;  // what is left of stresses of 1e4 Pa on faces of 1e-3 m^2
    for (const ToolContact law : {ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb}) {
        for (const double depth_m : {-1e-3, 0.0, 1e-15}) {
            const ContactTool tool = scene.plate(law, depth_m);
            for (const ContactSolution& solution :
                 {problem.step(problem.rest(), scene.held, {tool}, kDtS),
                  problem.linearised_step(problem.rest(), scene.held, {tool}, kDtS),
                  problem.equilibrium(scene.held, {tool})}) {
                EXPECT_LT(vec(solution.tools[0].force_n).norm(), kRoundingN);
                for (std::size_t n = 0; n < scene.mesh.nodes_m.size(); ++n)
                    EXPECT_LT((vec(solution.state.positions_m[n]) - vec(scene.mesh.nodes_m[n])).norm(),
                              kTolerance * kSideM);
            }
        }
    }
}

TEST(ContactProblem, Frictionless_plate_on_a_homogeneous_cube_gives_the_uniaxial_force_and_expansion) {
    Scene scene(4, false);
    constexpr double kStrain = 0.1;
    // Below: free to slide, but for one node, and for y of another one against turning.
    const std::size_t count = scene.held.nodes.size();
    scene.held.axes.assign(count, kAxisZ);
    scene.held.axes[0] = kAllAxes;
    scene.held.axes[4] = kAxisY | kAxisZ;
    ContactProblem problem(scene.mesh, scene.material);
    const ContactSolution solution =
        problem.equilibrium(scene.held, {scene.plate(ToolContact::frictionless, kStrain * kSideM)});
    // The corotational stress is linear in the stretches: E A strain, to any size.
    const double expected = kYoungsModulusPa * kSideM * kSideM * kStrain;
    EXPECT_NEAR(solution.tools[0].force_n[2], expected, kTolerance * expected);
    EXPECT_NEAR(std::hypot(solution.tools[0].force_n[0], solution.tools[0].force_n[1]), 0,
                kTolerance * expected);
    const Point corner = solution.state.positions_m.back();
    EXPECT_NEAR(corner[0], kSideM * (1 + 0.3 * kStrain), kTolerance);
    EXPECT_NEAR(corner[1], kSideM * (1 + 0.3 * kStrain), kTolerance);
    EXPECT_EQ(solution.touching, scene.top.size());
}

TEST(ContactProblem, Sticking_plate_on_all_top_nodes_is_the_plate_press) {
    const Scene scene(4);
    const PlatePress press = plate_press(scene.mesh, 0.1);
    StaticProblem bonded(scene.mesh, scene.material);
    const StaticSolution pressed = bonded.solve(press.motion);
    const Point expected = force_on_plate_n(press, pressed);
    ContactProblem problem(scene.mesh, scene.material);
    const ContactSolution solution =
        problem.equilibrium(scene.held, {scene.plate(ToolContact::sticking, 0.1 * kSideM)});
    ASSERT_EQ(solution.touching, scene.top.size());
    EXPECT_LT((vec(solution.tools[0].force_n) - vec(expected)).norm(), kTolerance * expected[2]);
    EXPECT_NEAR(solution.energy_j, pressed.energy_j, kTolerance * pressed.energy_j);
}

TEST(ContactProblem, Frictionless_plate_on_all_top_nodes_is_the_plate_press_with_slip) {
    const Scene scene(4);
    const PlatePress press = plate_press(scene.mesh, 0.1, PlateSlip::free);
    StaticProblem bonded(scene.mesh, scene.material);
    const Point expected = force_on_plate_n(press, bonded.solve(press.motion));
    ContactProblem problem(scene.mesh, scene.material);
    const ContactSolution solution =
        problem.equilibrium(scene.held, {scene.plate(ToolContact::frictionless, 0.1 * kSideM)});
    ASSERT_EQ(solution.touching, scene.top.size());
    EXPECT_NEAR(solution.tools[0].force_n[2], expected[2], kTolerance * expected[2]);
}

TEST(ContactProblem, Sphere_pressed_deeper_pushes_harder_and_equally_along_x_and_y) {
    const Scene scene(5, false);  // the cube's tetrahedra are their own mirror image when x and y are swapped
    ContactProblem problem(scene.mesh, scene.material);
    for (const ToolContact law : {ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb}) {
        double last_n = 0;
        std::size_t last_touching = 0;
        for (const double depth : {0.004, 0.008, 0.012, 0.016, 0.02}) {
            const ContactSolution solution = problem.equilibrium(scene.held, {scene.ball(law, depth)});
            const Point force = solution.tools[0].force_n;
            EXPECT_GT(force[2], last_n);
            EXPECT_NEAR(force[0], force[1], kTolerance * force[2]);
            EXPECT_GE(solution.touching, last_touching);
            last_n = force[2];
            last_touching = solution.touching;
        }
        EXPECT_GE(last_touching, 4u);
    }
}

TEST(ContactProblem, Coulomb_node_holds_until_the_coefficient_times_the_normal_force_and_then_slips_with_it) {
    OneTetrahedron one;
    ContactProblem problem(one.mesh, uniform_material(one.mesh, kYoungsModulusPa));
    one.tool.law = ToolContact::coulomb;
    one.tool.friction_coefficient = 0.3;
    one.tool.before = {{TouchMode::sticking, {0, 0, 0}}};
    one.tool.pose.position_m[2] -= 0.01;
    for (const double aside : {0.004, 0.02, 0.03}) {
        one.tool.pose.position_m[0] = aside;
        const ContactSolution solution = problem.equilibrium(one.held, {one.tool});
        const Point force = solution.tools[0].force_n;
        const double sideways = std::hypot(force[0], force[1]);
        EXPECT_LE(sideways, 0.3 * force[2] * (1 + kTolerance));
        if (aside < 0.01) {
            EXPECT_EQ(solution.tools[0].touches[0].mode, TouchMode::sticking);
            EXPECT_NEAR(solution.state.positions_m[3][0], aside, kTolerance);
        } else {
            EXPECT_EQ(solution.tools[0].touches[0].mode, TouchMode::sliding);
            EXPECT_NEAR(sideways, 0.3 * force[2], kTolerance * force[2]);
            EXPECT_LT(force[0], 0);  // the object drags the tool back
            EXPECT_NEAR(solution.tools[0].touches[0].anchor_m[0], solution.state.positions_m[3][0] - aside,
                        kTolerance);
        }
    }
}

TEST(ContactProblem, Cube_sheared_far_by_a_coulomb_plate_drags_with_the_coefficient_times_the_normal_force) {
    const Scene scene(3);
    ContactProblem problem(scene.mesh, scene.material);
    ContactTool tool = scene.plate(ToolContact::coulomb, 0.005);
    MotionState state = problem.rest();
    constexpr double kSpeed = 2;  // m/s, far beyond what the block follows
    ContactSolution solution;
    for (int k = 0; k < 20; ++k) {
        tool.pose_before = tool.pose;
        tool.pose.position_m[0] += kSpeed * kDtS;
        solution = problem.step(state, scene.held, {tool}, kDtS);
        state = solution.state;
        tool.before = solution.tools[0].touches;
    }
    double normal = 0;
    double along = 0;
    for (std::size_t k = 0; k < tool.nodes.size(); ++k) {
        const Point force = solution.tools[0].forces_n[k];
        if (force[2] == 0) continue;
        EXPECT_NEAR(std::hypot(force[0], force[1]), 0.4 * force[2], kTolerance);
        normal += force[2];
        along -= force[0];
    }
    EXPECT_GT(normal, 1);
    constexpr double kNodesMoveASideToo = 0.01;
    EXPECT_NEAR(along, 0.4 * normal, kNodesMoveASideToo * normal);
}

TEST(ContactProblem, Coulomb_with_a_huge_coefficient_is_sticking_and_with_none_is_frictionless) {
    const Scene scene(4);
    ContactProblem problem(scene.mesh, scene.material);
    const auto force = [&](ToolContact law, double coefficient) {
        ContactTool tool = scene.plate(law, 0.008);
        tool.friction_coefficient = coefficient;
        return vec(problem.equilibrium(scene.held, {tool}).tools[0].force_n);
    };
    const Vector3d stuck = force(ToolContact::sticking, 0);
    EXPECT_LT((force(ToolContact::coulomb, 1e3) - stuck).norm(), kTolerance * stuck.norm());
    const Vector3d smooth = force(ToolContact::frictionless, 0);
    EXPECT_LT((force(ToolContact::coulomb, 0) - smooth).norm(), kTolerance * stuck.norm());
    EXPECT_GT((stuck - smooth).norm(), 0.01 * stuck.norm());
}

TEST(ContactProblem, Capsule_without_length_is_the_sphere_and_a_long_one_touches_more) {
    const Scene scene(5);
    ContactProblem problem(scene.mesh, scene.material);
    for (const ToolContact law : {ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb}) {
        const ContactSolution ball = problem.equilibrium(scene.held, {scene.ball(law, 0.012)});
        ContactTool capsule = scene.ball(law, 0.012);
        capsule.shape = ToolShape::capsule;
        const ContactSolution round = problem.equilibrium(scene.held, {capsule});
        EXPECT_LT((vec(round.tools[0].force_n) - vec(ball.tools[0].force_n)).norm(), kTolerance);
        capsule.half_length_m = 0.03;
        capsule.pose.orientation_wxyz = {std::sqrt(0.5), 0, std::sqrt(0.5), 0};  // its z lies along x
        const ContactSolution lying = problem.equilibrium(scene.held, {capsule});
        EXPECT_GT(lying.touching, ball.touching);
        EXPECT_GT(lying.tools[0].force_n[2], ball.tools[0].force_n[2]);
    }
}

/// Scene, tool and start moved rigidly: what comes out moves with them.
TEST(ContactProblem, Scene_turned_and_moved_gives_the_force_and_torque_turned) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.9, Vector3d(1, -2, 0.7).normalized()));
    const Vector3d shift(0.3, -0.2, 0.5);
    const Scene scene(4);
    Scene moved = scene;
    const auto to = [&](const Point& p) {
        const Vector3d q = turn * vec(p) + shift;
        return Point{q.x(), q.y(), q.z()};
    };
    for (Point& node : moved.mesh.nodes_m)
        node = to(node);
    ContactProblem problem(scene.mesh, scene.material);
    ContactProblem turned(moved.mesh, moved.material);
    for (const ToolContact law : {ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb}) {
        ContactTool tool = scene.ball(law, 0.01, 0.06);
        tool.shape = ToolShape::capsule;
        tool.half_length_m = 0.02;
        const Eigen::Quaterniond lying(Eigen::AngleAxisd(1.2, Vector3d(0.6, 0.8, 0)));
        tool.pose.orientation_wxyz = {lying.w(), lying.x(), lying.y(), lying.z()};
        ContactTool other = tool;
        other.pose.position_m = to(tool.pose.position_m);
        const Eigen::Quaterniond both = turn * lying;
        other.pose.orientation_wxyz = {both.w(), both.x(), both.y(), both.z()};
        for (int mode = 0; mode < 3; ++mode) {
            const auto run = [&](ContactProblem& p, const ContactTool& t) {
                if (mode == 0) return p.equilibrium(scene.held, {t});
                if (mode == 1) return p.step(p.rest(), scene.held, {t}, kDtS);
                return p.linearised_step(p.rest(), scene.held, {t}, kDtS);
            };
            const ToolReaction a = run(problem, tool).tools[0];
            const ToolReaction b = run(turned, other).tools[0];
            const double scale = vec(a.force_n).norm();
            EXPECT_GT(scale, 0.1);
            EXPECT_LT((turn * vec(a.force_n) - vec(b.force_n)).norm(), kTolerance * scale);
            EXPECT_LT((turn * vec(a.torque_n_m) - vec(b.torque_n_m)).norm(), kTolerance * scale);
        }
    }
}

TEST(ContactProblem, Tool_forces_reactions_and_inertia_are_in_balance_in_every_step) {
    const Scene scene(4);
    BodyForces forces;
    forces.gravity_m_per_s2 = {0, 0, -9.81};
    forces.damping_per_s = 3;
    ContactProblem problem(scene.mesh, scene.material, forces);
    std::vector<double> mass(scene.mesh.nodes_m.size());
    for (std::size_t t = 0; t < scene.mesh.tetrahedra.size(); ++t)
        for (const std::uint32_t n : scene.mesh.tetrahedra[t])
            mass[n] += 1000 * signed_volume_m3(scene.mesh, t) / 4;
    ContactTool tool = scene.ball(ToolContact::coulomb, 0, 0.045);
    MotionState state = problem.rest();
    for (int k = 0; k < 12; ++k) {
        tool.pose_before = tool.pose;
        tool.pose.position_m[2] -= 0.001;
        tool.pose.position_m[0] += 0.0004;
        const ContactSolution solution = k % 2 == 0
                                             ? problem.step(state, scene.held, {tool}, kDtS)
                                             : problem.linearised_step(state, scene.held, {tool}, kDtS);
        Vector3d sum = vec(solution.tools[0].force_n);
        for (const Point& held : solution.held_reactions_n)
            sum += vec(held);
        for (std::size_t n = 0; n < mass.size(); ++n) {
            const Vector3d v0 = vec(state.velocities_m_per_s[n]);
            const Vector3d v1 = vec(solution.state.velocities_m_per_s[n]);
            sum += mass[n] * ((v1 - v0) / kDtS + 3 * v1 - vec(forces.gravity_m_per_s2));
        }
        EXPECT_LT(sum.norm(), kBalance * solution.check.force_scale_n);
        Vector3d torque = Vector3d::Zero();
        for (std::size_t i = 0; i < tool.nodes.size(); ++i)
            torque += (vec(solution.state.positions_m[tool.nodes[i]]) - vec(tool.pose.position_m))
                          .cross(vec(solution.tools[0].forces_n[i]));
        EXPECT_LT((torque - vec(solution.tools[0].torque_n_m)).norm(), kTolerance);
        state = solution.state;
        tool.before = solution.tools[0].touches;
    }
}

TEST(ContactProblem, Work_of_a_slow_frictionless_press_is_the_energy_stored) {
    const Scene scene(4);
    ContactProblem problem(scene.mesh, scene.material);
    constexpr int kParts = 60;
    constexpr double kDepthM = 0.015;
    double work = 0;
    double last = 0;
    double energy = 0;
    std::vector<Point> start;
    for (int k = 1; k <= kParts; ++k) {
        const ContactSolution solution = problem.equilibrium(
            scene.held, {scene.ball(ToolContact::frictionless, kDepthM * k / kParts)}, start);
        start = solution.state.positions_m;
        work += (last + solution.tools[0].force_n[2]) / 2 * kDepthM / kParts;
        last = solution.tools[0].force_n[2];
        energy = solution.energy_j;
    }
    constexpr double kTrapezoids = 1e-3;  // 60 parts, kinks where a node is touched
    EXPECT_NEAR(work, energy, kTrapezoids * energy);
}

TEST(ContactProblem, Plate_drawn_away_is_never_pulled_at_and_lets_go) {
    const Scene scene(3);
    for (const ToolContact law : {ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb}) {
        ContactProblem problem(scene.mesh, scene.material);
        ContactTool tool = scene.plate(law, 0.01);
        MotionState state = problem.rest();
        std::size_t most = 0;
        std::size_t now = 0;
        for (int k = 0; k < 25; ++k) {
            tool.pose.position_m[2] = kSideM - 0.01 + 0.001 * k;
            const ContactSolution solution = problem.step(state, scene.held, {tool}, kDtS);
            for (const Point& force : solution.tools[0].forces_n)
                EXPECT_GE(force[2], -solution.check.residual_limit_n);
            for (const std::uint32_t n : tool.nodes)
                EXPECT_LE(solution.state.positions_m[n][2], tool.pose.position_m[2] + 1e-11);
            state = solution.state;
            tool.before = solution.tools[0].touches;
            now = solution.touching;
            most = std::max(most, now);
        }
        EXPECT_EQ(most, tool.nodes.size());
        EXPECT_EQ(now, 0u);
    }
}

TEST(ContactProblem, Bounded_plate_touches_below_its_rectangle_and_leaves_alone_what_is_beside) {
    const Scene scene(4);
    ContactProblem problem(scene.mesh, scene.material);
    ContactTool tool = scene.plate(ToolContact::frictionless, 0.006);
    tool.half_extents_m = {0.03, 0.03};  // 3 x 3 of the 5 x 5 nodes
    const ContactSolution first = problem.equilibrium(scene.held, {tool});
    EXPECT_EQ(first.touching, 9u);
    std::size_t beside = 0;
    for (const NodeTouch& touch : first.tools[0].touches)
        beside += touch.mode == TouchMode::beside ? 1 : 0;
    EXPECT_GT(beside, 0u);
    ContactTool sticky = tool;
    sticky.law = ToolContact::sticking;
    EXPECT_EQ(problem.equilibrium(scene.held, {sticky}).touching, 9u);
    // Moved over the nodes that are behind its plane: they do not jump to its face.
    tool.before = first.tools[0].touches;
    tool.pose.position_m[0] += 0.025;
    const ContactSolution aside = problem.equilibrium(scene.held, {tool}, first.state.positions_m);
    for (std::size_t k = 0; k < tool.nodes.size(); ++k)
        if (first.tools[0].touches[k].mode == TouchMode::beside &&
            aside.state.positions_m[tool.nodes[k]][2] > tool.pose.position_m[2]) {
            EXPECT_EQ(aside.tools[0].touches[k].mode, TouchMode::beside);
        }
}

TEST(ContactProblem, Two_tools_at_once_push_against_each_other) {
    const Scene scene(4);
    ContactProblem problem(scene.mesh, scene.material);
    ContactTool left = scene.plate(ToolContact::sticking, 0);
    left.nodes.clear();
    ContactTool right = left;
    for (std::uint32_t n = 0; n < scene.mesh.nodes_m.size(); ++n) {
        if (scene.mesh.nodes_m[n][2] < 0.05) continue;
        left.nodes.push_back(n);
        right.nodes.push_back(n);
    }
    left.pose = {{0.005, 0.05, 0.05}, {std::sqrt(0.5), 0, -std::sqrt(0.5), 0}};  // its -z is +x
    right.pose = {{0.095, 0.05, 0.05}, {std::sqrt(0.5), 0, std::sqrt(0.5), 0}};  // its -z is -x
    const ContactSolution solution = problem.equilibrium(scene.held, {left, right});
    EXPECT_LT(solution.tools[0].force_n[0], -1);
    EXPECT_GT(solution.tools[1].force_n[0], 1);
    Vector3d sum = vec(solution.tools[0].force_n) + vec(solution.tools[1].force_n);
    for (const Point& held : solution.held_reactions_n)
        sum += vec(held);
    EXPECT_LT(sum.norm(), kBalance * solution.check.force_scale_n);
    EXPECT_THROW((void)problem.equilibrium(scene.held, {left, left}), ToolError);
}

TEST(ContactProblem, Bonded_tool_of_an_asset_is_the_prescribed_press_in_motion) {
    const Scene scene(3);
    ToolSet set;
    set.contact = ToolContact::bonded;
    set.rest_position_m = {0.05, 0.05, kSideM};
    set.nodes = scene.top;
    ContactTool tool = contact_tool(set, scene.mesh.nodes_m);
    ContactProblem problem(scene.mesh, scene.material);
    ImplicitEuler euler(scene.mesh, scene.material);
    const PlatePress press = plate_press(scene.mesh, -0.05);  // pulled up: a unilateral tool would let go
    tool.pose.position_m[2] += 0.05 * kSideM;
    MotionState a = problem.rest();
    MotionState b = a;
    for (int k = 0; k < 3; ++k) {
        const ContactSolution mine = problem.step(a, scene.held, {tool}, kDtS);
        const MotionStep theirs = euler.step(b, press.motion, kDtS);
        const double expected = force_on_plate_n(press, theirs.solution)[2];
        if (k == 0) {
            EXPECT_LT(expected, 0);
        }
        EXPECT_NEAR(mine.tools[0].force_n[2], expected, kTolerance * std::abs(expected));
        a = mine.state;
        b = theirs.state;
        tool.before = mine.tools[0].touches;
    }
}

TEST(ContactProblem, Caught_node_is_anchored_where_the_tool_says) {
    OneTetrahedron one;
    ContactProblem problem(one.mesh, uniform_material(one.mesh, kYoungsModulusPa));
    one.tool.pose_before.position_m = {0, 0, kSideM + 0.001};
    one.tool.pose.position_m = {0.002, 0, kSideM - 0.001};
    const auto anchor = [&](CatchPlace place) {
        one.tool.catch_place = place;
        MotionState state = problem.rest();
        state.velocities_m_per_s[3] = {0, 1, 0};
        return problem.linearised_step(state, one.held, {one.tool}, kDtS).tools[0].touches[0].anchor_m;
    };
    EXPECT_LT((vec(anchor(CatchPlace::predicted)) - Vector3d(-0.002, 0.002, 0)).norm(), kTolerance);
    EXPECT_LT((vec(anchor(CatchPlace::on_the_tool_before)) - Vector3d(0, 0, 0)).norm(), kTolerance);
    const Vector3d solved = vec(anchor(CatchPlace::solved_without_it));
    EXPECT_NEAR(solved[0], -0.002, 1e-4);  // elasticity moves it a little
    EXPECT_LT(solved[1], 0.002);
}

TEST(ContactProblem, Object_that_nothing_holds_and_bad_tools_are_refused) {
    const Scene scene(2);
    ContactProblem problem(scene.mesh, scene.material);
    const auto refused = [&](const std::function<void(ContactTool&)>& spoil) {
        ContactTool tool = scene.ball(ToolContact::coulomb, 0.01);
        spoil(tool);
        try {
            (void)problem.equilibrium(scene.held, {tool});
        } catch (const ToolError& error) {
            return error.code() == ExitCode::bad_input;
        }
        return false;
    };
    EXPECT_FALSE(refused([](ContactTool&) {}));
    EXPECT_TRUE(refused([](ContactTool& tool) { tool.radius_m = 0; }));
    EXPECT_TRUE(refused([](ContactTool& tool) { tool.friction_coefficient = -1; }));
    EXPECT_TRUE(refused([](ContactTool& tool) { tool.pose.orientation_wxyz = {2, 0, 0, 0}; }));
    EXPECT_TRUE(refused([](ContactTool& tool) { tool.pose.position_m[0] = std::nan(""); }));
    EXPECT_TRUE(refused([](ContactTool& tool) { tool.nodes.push_back(tool.nodes[0]); }));
    EXPECT_TRUE(refused([](ContactTool& tool) { tool.nodes.push_back(1000); }));
    EXPECT_TRUE(refused([](ContactTool& tool) { tool.before.resize(1); }));
    EXPECT_TRUE(refused([](ContactTool& tool) { tool.law = ToolContact::bonded; }));
    EXPECT_TRUE(refused([](ContactTool& tool) {
        tool.shape = ToolShape::plate;
        tool.half_extents_m = {0.1, 0};
    }));
    try {
        (void)problem.equilibrium({}, {scene.ball(ToolContact::sticking, 0.01)});
        FAIL();
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::no_valid_result);
    }
}

}  // namespace
}  // namespace knead::tools
