// SPDX-License-Identifier: Apache-2.0
#include "reference/plate_press.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

#include "common/error.h"
#include "support/kuhn_cube.h"
#include "unit/reference/uniform_material.h"

namespace knead::tools {
namespace {

using test::kuhn_cube;
using test::uniform_material;

constexpr double kYoungsModulusPa = 22000;
constexpr double kStrain = 0.1;
// Two programs of other authors agree on the figures below to seven digits; the issue asks for 0.01 %.
constexpr double kForceTolerance = 1e-4;
constexpr double kPrintedDigits = 1e-6;    // seven digits were printed
constexpr double kFactorTolerance = 5e-5;  // the factors are given with four decimals

struct KnownPress {
    std::uint32_t cells;
    double force_n;
    double factor;
};

void PrintTo(const KnownPress& known, std::ostream* out) {
    *out << "n = " << known.cells;
}

class KnownCube : public testing::TestWithParam<KnownPress> {};

TEST_P(KnownCube, Press_of_the_homogeneous_cube_without_slip_gives_the_known_force) {
    const TetMesh mesh = kuhn_cube(GetParam().cells);
    StaticProblem problem(mesh, uniform_material(mesh, kYoungsModulusPa));
    const PlatePress press = plate_press(mesh, kStrain);
    const StaticSolution solution = problem.solve(press.motion);
    const double force_n = force_on_plate_n(press, solution)[2];
    EXPECT_NEAR(force_n, GetParam().force_n, kForceTolerance * GetParam().force_n);
    EXPECT_NEAR(force_n, GetParam().force_n, kPrintedDigits * GetParam().force_n);
    EXPECT_NEAR(force_n / (kYoungsModulusPa * press.area_m2 * kStrain), GetParam().factor, kFactorTolerance);
    EXPECT_LE(solution.residual_n, 1e-10 * solution.force_scale_n);
    EXPECT_EQ(solution.load_steps, 1);
}

INSTANTIATE_TEST_SUITE_P(Sizes, KnownCube,
                         testing::Values(KnownPress{6, 23.82645, 1.0830}, KnownPress{8, 23.62790, 1.0740},
                                         KnownPress{10, 23.51532, 1.0689}),
                         [](const auto& known) {
                             return std::string(1, 'n').append(std::to_string(known.param.cells));
                         });

TEST(PlatePress, Upper_plate_with_slip_gives_the_known_lower_force_and_no_sideways_force) {
    const TetMesh mesh = kuhn_cube(10);
    StaticProblem problem(mesh, uniform_material(mesh, kYoungsModulusPa));
    const PlatePress press = plate_press(mesh, kStrain, PlateSlip::free);
    const StaticSolution solution = problem.solve(press.motion);
    const Point force = force_on_plate_n(press, solution);
    constexpr double kThreeDecimals = 5e-4;  // method.md gives the factor 1.033
    EXPECT_NEAR(force[2] / (kYoungsModulusPa * press.area_m2 * kStrain), 1.033, kThreeDecimals);
    EXPECT_NEAR(std::hypot(force[0], force[1]), 0, 1e-8 * force[2]);
}

TEST(PlatePress, One_problem_asked_for_both_kinds_of_plate_gives_each_the_answer_of_a_fresh_problem) {
    const TetMesh mesh = kuhn_cube(4);
    const Material material = uniform_material(mesh, kYoungsModulusPa);
    StaticProblem shared(mesh, material);
    for (const PlateSlip slip : {PlateSlip::none, PlateSlip::free, PlateSlip::none}) {
        const PlatePress press = plate_press(mesh, kStrain, slip);
        const double expected = force_on_plate_n(press, StaticProblem(mesh, material).solve(press.motion))[2];
        EXPECT_EQ(force_on_plate_n(press, shared.solve(press.motion))[2], expected);
    }
}

TEST(PlatePress, Force_is_proportional_to_the_elasticity_when_poissons_ratio_is_uniform) {
    const TetMesh mesh = kuhn_cube(4);
    const PlatePress press = plate_press(mesh, kStrain);
    Material soft = uniform_material(mesh, 1000);
    for (std::size_t t = 0; t < soft.youngs_modulus_pa.size(); t += 3)
        soft.youngs_modulus_pa[t] = 7000;
    Material stiff = soft;
    constexpr double kRatio = 37;
    for (double& e : stiff.youngs_modulus_pa)
        e *= kRatio;
    const double soft_n = force_on_plate_n(press, StaticProblem(mesh, soft).solve(press.motion))[2];
    const double stiff_n = force_on_plate_n(press, StaticProblem(mesh, stiff).solve(press.motion))[2];
    EXPECT_NEAR(stiff_n, kRatio * soft_n, 1e-9 * stiff_n);
}

TEST(PlatePress, Plates_of_a_box_are_its_lowest_and_highest_nodes) {
    TetMesh mesh = kuhn_cube(2, 0.2);
    for (Point& node : mesh.nodes_m)
        node = {node[0] + 1, 2 * node[1], 0.75 * node[2] - 3};
    const PlatePress press = plate_press(mesh, 0.25);
    EXPECT_EQ(press.held_nodes.size(), 9u);
    EXPECT_EQ(press.plate_nodes.size(), 9u);
    EXPECT_EQ(press.motion.nodes.size(), 18u);
    EXPECT_NEAR(press.height_m, 0.15, 1e-12);
    EXPECT_NEAR(press.area_m2, 0.08, 1e-12);
    EXPECT_NEAR(press.motion.displacement_m.back()[2], -0.0375, 1e-12);
}

TEST(PlatePress, Strain_of_one_or_more_or_not_finite_is_refused) {
    const TetMesh mesh = kuhn_cube(1);
    EXPECT_THROW((void)plate_press(mesh, 1.0), ToolError);
    EXPECT_THROW((void)plate_press(mesh, std::nan("")), ToolError);
    EXPECT_THROW((void)plate_press(TetMesh{}, 0.1), ToolError);
}

}  // namespace
}  // namespace knead::tools
