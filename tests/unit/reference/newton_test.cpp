// SPDX-License-Identifier: Apache-2.0
#include "reference/newton.h"

#include <gtest/gtest.h>

#include "reference/plate_press.h"
#include "reference/prescribed_unknowns.h"
#include "support/kuhn_cube.h"
#include "unit/reference/uniform_material.h"

namespace knead::tools {
namespace {

// The energy is a sum over the tetrahedra: changes below this share of it are rounding.
constexpr double kRoundingShare = 1e-9;

TEST(Newton, Objective_of_a_nearly_incompressible_body_crushed_by_half_never_rises_until_the_end) {
    const TetMesh mesh = test::kuhn_cube(3);
    Material material = test::uniform_material(mesh, 22000, 0.49);
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); t += 3)
        material.youngs_modulus_pa[t] *= 100;
    const ElasticBody body(mesh, material);
    const PlatePress press = plate_press(mesh, 0.5);
    const PrescribedUnknowns unknowns = spread(press.motion, body.rest_positions_m());
    FreeSystem system(body, unknowns.is_prescribed);
    Objective objective;
    objective.body = &body;

    Eigen::VectorXd positions = body.rest_positions_m();
    ASSERT_TRUE(follow_prescribed(objective, system, unknowns.target_m, positions));
    double value_j = objective.value_j(positions);
    NewtonOutcome outcome;
    for (int k = 0; k < 200 && !outcome.converged; ++k) {
        outcome = minimise(objective, system, 1e-10, 1, positions);
        const double next_j = objective.value_j(positions);
        EXPECT_LE(next_j, value_j * (1 + kRoundingShare)) << "iteration " << k;
        value_j = next_j;
    }
    EXPECT_TRUE(outcome.converged);
}

TEST(Newton, Nodes_that_follow_a_small_move_land_where_the_linear_solution_is) {
    const TetMesh mesh = test::kuhn_cube(3);
    const Material material = test::uniform_material(mesh, 22000);
    const PlatePress press = plate_press(mesh, 1e-3);
    const StaticSolution linear = StaticProblem(mesh, material).solve_linear(press.motion);
    const StaticSolution converged = StaticProblem(mesh, material).solve(press.motion);
    const double linear_n = force_on_plate_n(press, linear)[2];
    constexpr double kSecondOrder = 2e-3;  // the strain of 1e-3, times a factor of order one
    EXPECT_NEAR(force_on_plate_n(press, converged)[2], linear_n, kSecondOrder * linear_n);
    EXPECT_LT(linear.residual_n, 1e-10 * linear.force_scale_n);
}

}  // namespace
}  // namespace knead::tools
