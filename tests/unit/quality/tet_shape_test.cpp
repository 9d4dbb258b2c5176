// SPDX-License-Identifier: Apache-2.0
#include "quality/tet_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace knead::tools {
namespace {

constexpr double kRounding = 1e-12;         // a few units of the last place of numbers around 1
constexpr double kDegreeRounding = 1e-10;   // likewise, of angles around 100
constexpr double kThinRounding_deg = 1e-7;  // an angle of 0.5 degrees from differences of numbers around 1

double degrees(double radians) {
    return radians * 180 / std::numbers::pi;
}

TEST(TetShape, Of_the_regular_tetrahedron_is_one_with_equal_angles) {
    const TetShape shape = shape_of({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1});
    EXPECT_NEAR(shape.radius_ratio, 1, kRounding);
    EXPECT_NEAR(shape.mean_ratio, 1, kRounding);
    EXPECT_NEAR(shape.min_dihedral_deg, degrees(std::acos(1.0 / 3)), kDegreeRounding);
    EXPECT_NEAR(shape.max_dihedral_deg, degrees(std::acos(1.0 / 3)), kDegreeRounding);
    EXPECT_NEAR(shape.thinness, std::sqrt(2.0 / 3), kRounding);
    EXPECT_NEAR(shape.shortest_edge_m, std::sqrt(8.0), kRounding);
    EXPECT_NEAR(shape.longest_edge_m, std::sqrt(8.0), kRounding);
    EXPECT_NEAR(shape.mean_edge_m, std::sqrt(8.0), kRounding);
}

TEST(TetShape, Of_the_corner_of_the_unit_cube_is_as_computed_by_hand) {
    const TetShape shape = shape_of({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    // Inscribed radius 1 / (3 + sqrt 3), circumscribed sqrt(3) / 2.
    EXPECT_NEAR(shape.radius_ratio, 3 / (3 + std::sqrt(3.0)) / (std::sqrt(3.0) / 2), kRounding);
    EXPECT_NEAR(shape.mean_ratio, 12 * std::pow(0.5, 2.0 / 3) / 9, kRounding);  // 3 V = 1/2, edges^2 sum to 9
    EXPECT_NEAR(shape.min_dihedral_deg, degrees(std::acos(1 / std::sqrt(3.0))), kDegreeRounding);
    EXPECT_NEAR(shape.max_dihedral_deg, 90, kDegreeRounding);
    EXPECT_NEAR(shape.smallest_height_m, 1 / std::sqrt(3.0), kRounding);
    EXPECT_NEAR(shape.thinness, 1 / std::sqrt(6.0), kRounding);
    EXPECT_NEAR(shape.mean_edge_m, (3 + 3 * std::sqrt(2.0)) / 6, kRounding);
}

/// Four nodes near a square: the ends of its two diagonals, h apart. Seen along the first diagonal, the ends
/// of the other lie at (+-1, h): an angle of pi - 2 atan(h). The normals of two faces at a side are (0, h, 1)
/// and
/// (-h, 0, 1): an angle whose tangent is h sqrt(2 + h^2).
TEST(TetShape, Of_a_sliver_has_its_known_angles) {
    for (const double angle_deg : {20.0, 5.0, 0.5}) {
        const double h = std::tan(0.5 * angle_deg * std::numbers::pi / 180);
        const TetShape shape = shape_of({-1, 0, 0}, {1, 0, 0}, {0, -1, h}, {0, 1, h});
        EXPECT_NEAR(shape.max_dihedral_deg, 180 - angle_deg, kThinRounding_deg);
        EXPECT_NEAR(shape.min_dihedral_deg, degrees(std::atan(h * std::sqrt(2 + h * h))), kThinRounding_deg);
        const double face_m2 = std::sqrt(1 + h * h);  // all four alike; 3 V = 2 h
        EXPECT_NEAR(shape.smallest_height_m, 2 * h / face_m2, kRounding);
        EXPECT_NEAR(shape.thinness, h / face_m2, kRounding);
    }
}

TEST(TetShape, Of_a_flat_one_is_zero_with_straight_angles) {
    const TetShape shape = shape_of({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0});
    EXPECT_EQ(shape.radius_ratio, 0);
    EXPECT_EQ(shape.mean_ratio, 0);
    EXPECT_EQ(shape.thinness, 0);
    EXPECT_EQ(shape.min_dihedral_deg, 0);
    EXPECT_NEAR(shape.max_dihedral_deg, 180, kDegreeRounding);
}

TEST(TetShape, Does_not_depend_on_orientation_or_size) {
    const Point a{0, 0, 0}, b{1e-3, 0, 0}, c{2e-4, 7e-4, 0}, d{1e-4, 3e-4, 5e-4};
    const Point large_b{10, 0, 0}, large_c{2, 7, 0}, large_d{1, 3, 5};
    const TetShape small = shape_of(a, b, c, d);
    const TetShape turned_inside_out = shape_of(b, a, c, d);
    const TetShape large = shape_of(a, large_b, large_c, large_d);
    for (const TetShape& other : {turned_inside_out, large}) {
        EXPECT_NEAR(other.radius_ratio, small.radius_ratio, kRounding);
        EXPECT_NEAR(other.mean_ratio, small.mean_ratio, kRounding);
        EXPECT_NEAR(other.min_dihedral_deg, small.min_dihedral_deg, kDegreeRounding);
        EXPECT_NEAR(other.max_dihedral_deg, small.max_dihedral_deg, kDegreeRounding);
        EXPECT_NEAR(other.thinness, small.thinness, kRounding);
    }
}

}  // namespace
}  // namespace knead::tools
