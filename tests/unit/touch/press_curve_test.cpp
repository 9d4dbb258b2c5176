// SPDX-License-Identifier: Apache-2.0
#include "touch/press_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "touch/renderability.h"
#include "unit/runtime/block_asset.h"

namespace knead::tools::test {
namespace {

using knead::test::cube_asset;
using knead::test::kGel;

constexpr double kSide_m = 0.1;

PressCurve curve_of(const Asset& asset) {
    return press_curve(asset, 0, press_line(asset, 0));
}

// Oracle: a bar that may widen freely is softer, one that may not widen at all is stiffer.
TEST(Press_curve, Of_a_cube_between_plates_lies_between_a_free_and_a_confined_bar) {
    const double nu = kGel.poissons_ratio, free_n_per_m = kGel.youngs_modulus_pa * kSide_m;
    const double confined_n_per_m = free_n_per_m * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
    const PressCurve curve = curve_of(cube_asset(4, ToolShape::plate, ToolContact::bonded));
    const PressPoint point = *curve.at(1e-3);
    EXPECT_GT(point.force_n, 1e-3 * free_n_per_m);
    EXPECT_LT(point.force_n, 1e-3 * confined_n_per_m);
    EXPECT_NEAR(curve.deepest_m(), kDeepestPress_m, 1e-12);
}

// Oracle: the difference quotient of the forces.
TEST(Press_curve, Stiffness_is_the_slope_of_the_force) {
    constexpr double kSettled = 2e-2;  ///< relative: stairs of finite length, forces at rest to some 1e-3
    const PressCurve curve = curve_of(cube_asset(3, ToolShape::plate, ToolContact::bonded));
    const PressPoint a = *curve.at(2e-3), middle = *curve.at(2.25e-3), b = *curve.at(2.5e-3);
    const double slope = (b.force_n - a.force_n) / (b.depth_m - a.depth_m);
    EXPECT_NEAR(middle.stiffness_n_per_m / slope, 1, kSettled);
}

TEST(Press_curve, Of_a_ball_in_the_air_touches_later) {
    Asset asset = cube_asset(4, ToolShape::sphere, ToolContact::frictionless);
    asset.tools[0].rest_position_m[2] += 2e-3;
    const PressCurve curve = curve_of(asset);
    ASSERT_TRUE(curve.contact());
    EXPECT_NEAR(curve.contact()->depth_m, 2e-3, 2 * curve.stair_m);
    EXPECT_EQ(curve.at(1e-3)->force_n, 0);
}

TEST(Press_curve, Depth_of_a_force_is_where_that_force_is) {
    PressCurve curve;
    curve.stair_m = 1e-3;
    curve.points = {{0, 0, 0, 0}, {1e-3, 1, 0, 4}, {2e-3, 3, 0, 4}};
    EXPECT_DOUBLE_EQ(*curve.depth_of_force(2), 1.5e-3);
    EXPECT_DOUBLE_EQ(*curve.depth_of_force(3), 2e-3);
    EXPECT_FALSE(curve.depth_of_force(3.1));
    EXPECT_DOUBLE_EQ(curve.at(0.25e-3)->force_n, 0.25);
    EXPECT_FALSE(curve.at(2.1e-3));
    EXPECT_DOUBLE_EQ(curve.contact()->depth_m, 1e-3);
}

TEST(Press_curve, Of_a_small_object_stops_at_its_share) {
    Asset asset = cube_asset(2, ToolShape::plate, ToolContact::bonded);
    for (Point& node : asset.nodes_m)
        for (double& x : node)
            x *= 0.1;
    for (double& x : asset.tools[0].rest_position_m)
        x *= 0.1;
    EXPECT_NEAR(curve_of(asset).deepest_m(), 0.1 * kSide_m * kDeepestShare, 1e-9);
}

}  // namespace
}  // namespace knead::tools::test
