// SPDX-License-Identifier: Apache-2.0
#include "evaluate/loads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "common/error.h"
#include "reference/plate_press.h"
#include "support/kuhn_cube.h"
#include "unit/reference/uniform_material.h"

namespace knead::tools {
namespace {

constexpr double kSideM = 0.1;
// Areas are sums of a few hundred cut triangles in double precision.
constexpr double kAreaTolerance = 1e-12;
constexpr double kLengthTolerance = 1e-12;
// Newton's residual is 1e-10 of the reactions.
constexpr double kForceTolerance = 1e-7;

std::vector<bool> held_bottom(const TetMesh& mesh) {
    std::vector<bool> held;
    for (const Point& node : mesh.nodes_m)
        held.push_back(node[2] == 0);
    return held;
}

Box cube_box() {
    return {{0, 0, 0}, {kSideM, kSideM, kSideM}};
}

AppliedLoad applied(const char* name, const TetMesh& mesh) {
    return apply_load(named_load(name, cube_box()), mesh, held_bottom(mesh));
}

class PadOnMesh : public testing::TestWithParam<std::uint32_t> {};

TEST_P(PadOnMesh, Area_of_every_pad_is_the_same_whatever_the_mesh) {
    const TetMesh mesh = test::kuhn_cube(GetParam());
    const auto area = [&](const char* name) {
        return mesh_region(mesh, named_load(name, cube_box()).region).area_m2;
    };
    EXPECT_NEAR(area("pad4"), 0.04 * 0.04, kAreaTolerance);
    EXPECT_NEAR(area("pad3"), 0.03 * 0.03, kAreaTolerance);
    EXPECT_NEAR(area("tip2"), 0.02 * 0.02, kAreaTolerance);
    EXPECT_NEAR(area("side"), 0.04 * 0.04, kAreaTolerance);
    EXPECT_NEAR(area("press10"), 0.1 * 0.1, kAreaTolerance);
}

TEST_P(PadOnMesh, Every_tied_node_and_its_masters_lie_on_the_face_that_the_pad_touches) {
    const TetMesh mesh = test::kuhn_cube(GetParam());
    for (const TiedNode& tie : applied("pad4", mesh).motion.ties) {
        EXPECT_NEAR(mesh.nodes_m[tie.node][2], kSideM, kLengthTolerance);
        for (const auto& [master, weight] : tie.masters)
            EXPECT_NEAR(mesh.nodes_m[master][2], kSideM, kLengthTolerance);
    }
}

TEST_P(PadOnMesh, Surface_that_moves_with_the_pad_everywhere_meets_every_tie) {
    const TetMesh mesh = test::kuhn_cube(GetParam());
    for (const char* name : {"pad4", "pad3", "tip2", "side"}) {
        const Load load = named_load(name, cube_box());
        const AppliedLoad on_mesh = apply_load(load, mesh, held_bottom(mesh));
        for (const TiedNode& tie : on_mesh.motion.ties)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                double displacement = tie.displacement_m[axis];
                for (const auto& [master, weight] : tie.masters)
                    displacement += weight * load.motion.translation_m[axis];
                EXPECT_NEAR(displacement, load.motion.translation_m[axis], kLengthTolerance) << name;
            }
    }
}

INSTANTIATE_TEST_SUITE_P(Meshes, PadOnMesh, testing::Values(10, 8, 6, 7, 3));

TEST(Loads, Pad_on_a_mesh_with_nodes_along_its_border_is_a_plain_prescribed_motion) {
    const TetMesh mesh = test::kuhn_cube(10);
    const AppliedLoad pad = applied("pad4", mesh);
    EXPECT_TRUE(pad.motion.ties.empty());
    EXPECT_EQ(pad.motion.nodes.size() - pad.held_count, 25u);  // 4 cm, a node each centimetre
    for (std::size_t k = pad.held_count; k < pad.motion.nodes.size(); ++k) {
        const Point& node = mesh.nodes_m[pad.motion.nodes[k]];
        EXPECT_GE(node[0], 0.01 - kLengthTolerance);
        EXPECT_LE(node[0], 0.05 + kLengthTolerance);
        EXPECT_GE(node[1], 0.04 - kLengthTolerance);
        EXPECT_LE(node[1], 0.08 + kLengthTolerance);
        EXPECT_NEAR(node[2], kSideM, kLengthTolerance);
        EXPECT_NEAR(pad.motion.displacement_m[k][2], -0.01, kLengthTolerance);
    }
}

TEST(Loads, Pad_that_covers_triangles_in_part_is_tied_and_not_widened) {
    const AppliedLoad pad = applied("pad4", test::kuhn_cube(6));
    EXPECT_FALSE(pad.motion.ties.empty());
}

TEST(Loads, Held_nodes_come_first_and_do_not_move) {
    const TetMesh mesh = test::kuhn_cube(4);
    const AppliedLoad press = applied("press10", mesh);
    ASSERT_EQ(press.held_count, 25u);
    for (std::size_t k = 0; k < press.held_count; ++k) {
        EXPECT_EQ(mesh.nodes_m[press.motion.nodes[k]][2], 0);
        EXPECT_EQ(press.motion.displacement_m[k], Point{});
    }
}

TEST(Loads, Twist_turns_the_upper_face_by_twenty_degrees_about_its_middle) {
    const TetMesh mesh = test::kuhn_cube(4);
    const AppliedLoad twist = applied("twist", mesh);
    const double angle = 20 * std::numbers::pi / 180;
    for (std::size_t k = twist.held_count; k < twist.motion.nodes.size(); ++k) {
        const Point& rest = mesh.nodes_m[twist.motion.nodes[k]];
        const double x = rest[0] - 0.05;
        const double y = rest[1] - 0.05;
        const Point& moved = twist.motion.displacement_m[k];
        EXPECT_NEAR(x + moved[0], std::cos(angle) * x - std::sin(angle) * y, kLengthTolerance);
        EXPECT_NEAR(y + moved[1], std::sin(angle) * x + std::cos(angle) * y, kLengthTolerance);
        EXPECT_EQ(moved[2], 0);
    }
}

TEST(Loads, Felt_force_of_the_press_is_the_force_on_the_plate) {
    const TetMesh mesh = test::kuhn_cube(4);
    const Material material = test::uniform_material(mesh, 22000, 0.3);
    const AppliedLoad load = applied("press10", mesh);
    const double felt = felt_force_n(load, StaticProblem(mesh, material).solve(load.motion));
    const PlatePress press = plate_press(mesh, 0.1);
    const double expected = force_on_plate_n(press, StaticProblem(mesh, material).solve(press.motion))[2];
    EXPECT_NEAR(felt, expected, kForceTolerance * expected);
}

/// The felt force is the derivative of the stored energy to the way of the pad, ties or not: an oracle that
/// knows nothing of reactions.
TEST(Loads, Felt_force_of_a_tied_pad_is_the_derivative_of_the_energy_to_its_way) {
    const TetMesh mesh = test::kuhn_cube(6);
    const Material material = test::uniform_material(mesh, 22000, 0.3);
    const auto energy_j = [&](double share) {
        Load load = named_load("pad4", cube_box());
        load.motion.translation_m[2] *= share;
        return StaticProblem(mesh, material).solve(apply_load(load, mesh, held_bottom(mesh)).motion).energy_j;
    };
    constexpr double kStep = 1e-3;
    constexpr double kWayM = 0.01;
    const double slope_n = (energy_j(1 + kStep) - energy_j(1 - kStep)) / (2 * kStep * kWayM);
    const AppliedLoad load = applied("pad4", mesh);
    const double felt = felt_force_n(load, StaticProblem(mesh, material).solve(load.motion));
    EXPECT_NEAR(felt, slope_n, 1e-5 * slope_n);  // central differences: the step squared, and some curvature
}

TEST(Loads, Felt_force_of_the_twist_is_the_derivative_of_the_energy_to_its_angle) {
    const TetMesh mesh = test::kuhn_cube(4);
    const Material material = test::uniform_material(mesh, 22000, 0.3);
    const auto energy_j = [&](double angle_rad) {
        Load load = named_load("twist", cube_box());
        load.motion.angle_rad = angle_rad;
        return StaticProblem(mesh, material).solve(apply_load(load, mesh, held_bottom(mesh)).motion).energy_j;
    };
    const double angle = 20 * std::numbers::pi / 180;
    constexpr double kStepRad = 1e-3;
    const double moment_nm = (energy_j(angle + kStepRad) - energy_j(angle - kStepRad)) / (2 * kStepRad);
    const AppliedLoad load = applied("twist", mesh);
    const double felt = felt_force_n(load, StaticProblem(mesh, material).solve(load.motion));
    EXPECT_NEAR(felt, moment_nm / 0.05, 1e-5 * felt);  // the lever is half of the side
}

TEST(Loads, Unknown_name_is_bad_usage) {
    try {
        (void)named_load("press15", cube_box());
        FAIL();
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_usage);
    }
}

TEST(Loads, Tool_on_held_nodes_is_refused) {
    const TetMesh mesh = test::kuhn_cube(2);
    EXPECT_THROW((void)apply_load(named_load("press10", cube_box()), mesh,
                                  std::vector<bool>(mesh.nodes_m.size(), true)),
                 ToolError);
}

}  // namespace
}  // namespace knead::tools
