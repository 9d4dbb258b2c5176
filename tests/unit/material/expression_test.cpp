// SPDX-License-Identifier: Apache-2.0
#include "material/expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/error.h"
#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using tools::evaluate_expression;

TEST(Expression, Is_evaluated_at_the_barycentre_of_every_tetrahedron) {
    const TetMesh mesh = kuhn_cube(3);
    const auto values = evaluate_expression(mesh, "1e4 + 2e5*x - 3e4*y*y + (z < 0.05 ? 1e3 : 0)");
    ASSERT_EQ(values.size(), mesh.tetrahedra.size());
    for (std::size_t t = 0; t < values.size(); ++t) {
        const Point c = barycentre_m(mesh, t);
        const double expected = 1e4 + 2e5 * c[0] - 3e4 * c[1] * c[1] + (c[2] < 0.05 ? 1e3 : 0);
        EXPECT_NEAR(values[t], expected, 1e-9 * expected);  // rounding of a handful of operations
    }
}

TEST(Expression, A_constant_holds_everywhere) {
    EXPECT_EQ(evaluate_expression(kuhn_cube(1), "5000"), std::vector<double>(6, 5000.0));
}

TEST(Expression, What_is_not_an_expression_of_x_y_z_is_bad_usage) {
    for (const char* text :
         {"", "  ", "2*", "w + 1", "sin(", "1, 2", "x = 3", "y += 2", "\"text\"", "1 2", "x y"}) {
        try {
            (void)evaluate_expression(kuhn_cube(1), text);
            ADD_FAILURE() << '"' << text << "\" was accepted";
        } catch (const tools::ToolError& error) {
            EXPECT_EQ(error.code(), tools::ExitCode::bad_usage) << text;
        }
    }
}

TEST(Expression, Comparisons_are_not_taken_for_assignments) {
    const TetMesh mesh = kuhn_cube(1);
    EXPECT_EQ(evaluate_expression(mesh, "x >= 0 && x <= 1 && x != 7 && 1 == 1 ? 10 : 20"),
              std::vector<double>(6, 10.0));
}

}  // namespace
}  // namespace knead::test
