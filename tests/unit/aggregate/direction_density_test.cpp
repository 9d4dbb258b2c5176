// SPDX-License-Identifier: Apache-2.0
#include "aggregate/direction_density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace knead::test {
namespace {

using tools::DirectionDensity;

/// A cell of the sphere is 7.5 degrees wide; at 30 degrees the weight changes by 1.8 % per degree, and both
/// the volume and the place asked for are moved to the middle of their cells.
constexpr double kCellError = 0.15;

TEST(Direction_density, Is_largest_towards_the_volume_halves_at_30_degrees_and_ignores_the_distance) {
    DirectionDensity density;
    density.add({0, 0, 2}, 3.0);
    density.finish();
    const auto at = [&](double degrees) {
        const double angle = degrees * std::numbers::pi / 180;
        return density.relative({5 * std::sin(angle), 0, 5 * std::cos(angle)});
    };
    EXPECT_NEAR(at(0), 1.0, kCellError);
    EXPECT_NEAR(at(30), 0.5, kCellError);
    EXPECT_NEAR(at(60), std::exp(-0.5 * std::numbers::ln2 / (1 - std::sqrt(0.75))), kCellError);
    EXPECT_LT(at(180), 1e-3);
    EXPECT_GT(at(10), at(40));
    EXPECT_GT(at(40), at(90));
}

TEST(Direction_density, Weighs_by_volume) {
    DirectionDensity density;
    density.add({1, 0, 0}, 4.0);
    density.add({-1, 0, 0}, 1.0);
    density.finish();
    EXPECT_NEAR(density.relative({-2, 0, 0}), 0.25, 0.02);
    EXPECT_NEAR(density.relative({2, 0, 0}), 1.0, 1e-12);
}

TEST(Direction_density, Of_an_even_cloud_is_even) {
    DirectionDensity density;
    std::mt19937_64 engine(1);
    for (int i = 0; i < 100000;) {
        Point point{};
        double squared = 0;
        for (double& coordinate : point) {
            coordinate = 2 * static_cast<double>(engine() >> 11U) * 0x1.0p-53 - 1;
            squared += coordinate * coordinate;
        }
        if (squared > 1) continue;
        density.add(point, 1.0);
        ++i;
    }
    density.finish();
    for (const Point& direction : {Point{1, 0, 0}, {0, -1, 0}, {1, 1, 1}, {-1, 1, 0}, {.2, -.4, .9}})
        EXPECT_GT(density.relative(direction), 0.9);  // noise and cells of unequal size
}

TEST(Direction_density, Without_direction_or_volume_is_one) {
    DirectionDensity density;
    density.add({0, 0, 0}, 1.0);
    density.finish();
    EXPECT_EQ(density.relative({0, 0, 0}), 1.0);
    EXPECT_EQ(density.relative({0, 1, 0}), 1.0);
}

}  // namespace
}  // namespace knead::test
