// SPDX-License-Identifier: Apache-2.0
#include "reference/implicit_euler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/error.h"
#include "reference/plate_press.h"
#include "support/kuhn_cube.h"
#include "unit/reference/uniform_material.h"

namespace knead::tools {
namespace {

using test::kuhn_cube;
using test::uniform_material;

constexpr double kYoungsModulusPa = 22000;
constexpr double kDensity = 1000;
constexpr double kSideM = 0.1;
constexpr double kDtS = 0.01;
constexpr double kTolerance = 1e-9;  // Newton's residual of 1e-10, with room for sums

TEST(ImplicitEuler, Body_in_free_fall_moves_as_the_recurrence_says_and_feels_no_force) {
    const TetMesh mesh = kuhn_cube(2);
    BodyForces forces;
    forces.gravity_m_per_s2 = {0, 1, -9.81};
    forces.damping_per_s = 2;
    ImplicitEuler euler(mesh, uniform_material(mesh, kYoungsModulusPa), forces);
    MotionState state = euler.rest();
    double v = 0;
    double z = 0;
    for (int k = 0; k < 5; ++k) {
        const MotionStep step = euler.step(state, {}, kDtS);
        state = step.state;
        v = (v - 9.81 * kDtS) / (1 + 2 * kDtS);
        z += v * kDtS;
        EXPECT_NEAR(step.solution.energy_j, 0, 1e-12);
    }
    for (std::size_t n = 0; n < mesh.nodes_m.size(); ++n) {
        EXPECT_NEAR(state.positions_m[n][2], mesh.nodes_m[n][2] + z, kTolerance);
        EXPECT_NEAR(state.velocities_m_per_s[n][2], v, kTolerance / kDtS);
    }
}

TEST(ImplicitEuler, Free_body_set_moving_keeps_its_momentum) {
    const TetMesh mesh = kuhn_cube(3);
    ImplicitEuler euler(mesh, uniform_material(mesh, kYoungsModulusPa));
    MotionState state = euler.rest();
    for (std::size_t n = 0; n < mesh.nodes_m.size(); ++n)
        state.velocities_m_per_s[n] = {0.5, mesh.nodes_m[n][2] * 20, -mesh.nodes_m[n][0] * 30};
    // Lumped: a quarter of each tetrahedron's mass at each of its nodes.
    std::vector<double> mass(mesh.nodes_m.size());
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        for (const std::uint32_t n : mesh.tetrahedra[t])
            mass[n] += kDensity * signed_volume_m3(mesh, t) / 4;
    const auto momentum = [&](std::size_t axis) {
        double sum = 0;
        for (std::size_t n = 0; n < mass.size(); ++n)
            sum += mass[n] * state.velocities_m_per_s[n][axis];
        return sum;
    };
    const Point before{momentum(0), momentum(1), momentum(2)};
    for (int k = 0; k < 10; ++k)
        state = euler.step(state, {}, kDtS).state;
    for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(momentum(axis), before[axis], kTolerance * std::abs(before[2]));
}

TEST(ImplicitEuler, One_tetrahedron_pulled_at_its_free_node_obeys_the_equation_of_the_step) {
    TetMesh mesh;
    mesh.nodes_m = {{0, 0, 0}, {kSideM, 0, 0}, {0, kSideM, 0}, {0, 0, kSideM}};
    mesh.tetrahedra = {{0, 1, 2, 3}};
    constexpr double kNu = 0.3;
    ImplicitEuler euler(mesh, uniform_material(mesh, kYoungsModulusPa, kNu));
    PrescribedMotion held;
    held.nodes = {0, 1, 2};
    held.displacement_m.assign(3, Point{0, 0, 0});
    MotionState state = euler.rest();
    state.velocities_m_per_s[3] = {0, 0, 1};
    const MotionStep step = euler.step(state, held, kDtS);
    // Along z the gradient stays diagonal: R = I, P_zz = (2 mu + lambda) (F_zz - 1), force = -V P_zz /
    // height.
    const double volume = kSideM * kSideM * kSideM / 6;
    const double modulus = kYoungsModulusPa * (1 - kNu) / ((1 + kNu) * (1 - 2 * kNu));
    const double mass = kDensity * volume / 4;
    const double stiffness = volume * modulus / (kSideM * kSideM);
    const double moved = mass / kDtS * 1 / (mass / (kDtS * kDtS) + stiffness);
    EXPECT_NEAR(step.state.positions_m[3][2] - kSideM, moved, kTolerance * moved);
    EXPECT_NEAR(step.state.velocities_m_per_s[3][2], moved / kDtS, kTolerance * moved / kDtS);
    // Nodes 0, 1, 2 do not move: what they feel is elastic alone. Their z forces sum to that of node 3's.
    double push = 0;
    for (const Point& force : step.solution.reactions_n)
        push += force[2];
    EXPECT_NEAR(push, stiffness * moved, kTolerance * stiffness * moved);
}

TEST(ImplicitEuler, Moved_node_feels_its_own_inertia) {
    TetMesh mesh;
    mesh.nodes_m = {{0, 0, 0}, {kSideM, 0, 0}, {0, kSideM, 0}, {0, 0, kSideM}};
    mesh.tetrahedra = {{0, 1, 2, 3}};
    ImplicitEuler euler(mesh, uniform_material(mesh, kYoungsModulusPa));
    PrescribedMotion all;
    all.nodes = {0, 1, 2, 3};
    constexpr double kMoveM = 0.002;
    all.displacement_m.assign(4, Point{0, 0, kMoveM});  // rigid: no elastic force
    const MotionStep step = euler.step(euler.rest(), all, kDtS);
    const double mass = kDensity * kSideM * kSideM * kSideM / 6;
    double push = 0;
    for (const Point& force : step.solution.reactions_n)
        push += force[2];
    EXPECT_NEAR(push, -mass * kMoveM / (kDtS * kDtS), kTolerance * mass * kMoveM / (kDtS * kDtS));
}

TEST(ImplicitEuler, Body_held_in_a_press_comes_to_the_equilibrium_of_the_static_problem) {
    const TetMesh mesh = kuhn_cube(3);
    Material material = uniform_material(mesh, kYoungsModulusPa);
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); t += 2)
        material.youngs_modulus_pa[t] = 5000;
    const PlatePress press = plate_press(mesh, 0.1);
    const double expected = force_on_plate_n(press, StaticProblem(mesh, material).solve(press.motion))[2];
    ImplicitEuler euler(mesh, material);
    MotionState state = euler.rest();
    double force = 0;
    for (int k = 0; k < 12; ++k) {
        const MotionStep step = euler.step(state, press.motion, 1.0);  // long steps: inertia fades quickly
        state = step.state;
        force = force_on_plate_n(press, step.solution)[2];
    }
    EXPECT_NEAR(force, expected, kTolerance * expected);
}

TEST(ImplicitEuler, Bad_time_step_state_or_body_force_is_refused) {
    const TetMesh mesh = kuhn_cube(1);
    const Material material = uniform_material(mesh, kYoungsModulusPa);
    ImplicitEuler euler(mesh, material);
    for (const double dt : {0.0, -1.0, std::numeric_limits<double>::infinity()})
        EXPECT_THROW((void)euler.step(euler.rest(), {}, dt), ToolError);
    MotionState short_state = euler.rest();
    short_state.velocities_m_per_s.pop_back();
    EXPECT_THROW((void)euler.step(short_state, {}, kDtS), ToolError);
    BodyForces negative;
    negative.damping_per_s = -1;
    EXPECT_THROW(ImplicitEuler(mesh, material, negative), ToolError);
}

}  // namespace
}  // namespace knead::tools
