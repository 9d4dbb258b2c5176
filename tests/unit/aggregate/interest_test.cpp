// SPDX-License-Identifier: Apache-2.0
#include "aggregate/interest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using namespace tools;

constexpr double kRounding = 1e-12;

/// A bar of 8 x 2 x 2 cells of side 1 as one cluster around its middle.
struct Bar {
    TetMesh mesh = kuhn_box(8, 2, 2, {8, 2, 2});
    ClusterShape cluster{{4, 1, 1}, 32, {}};
    Bar() {
        for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
            cluster.tetrahedra.push_back(t);
    }
    Interest interest(InterestKind kind, double weight = 0.25) const { return {kind, weight, mesh, cluster}; }
};

TEST(Interest, Distance_is_in_radii_of_the_ball_of_the_clusters_volume) {
    const double radius = std::cbrt(32 * 3 / (4 * std::numbers::pi));
    EXPECT_NEAR(Bar().interest(InterestKind::distance)({4, 1, 1 + 3 * radius}, false), 3.0, kRounding);
}

TEST(Interest, Membership_adds_its_weight_to_strangers) {
    const Bar bar;
    const Interest interest = bar.interest(InterestKind::membership, 0.7);
    const double plain = bar.interest(InterestKind::distance)({6, 1, 1}, true);
    EXPECT_NEAR(interest({6, 1, 1}, true), plain, kRounding);
    EXPECT_NEAR(interest({6, 1, 1}, false), plain + 0.7, kRounding);
}

TEST(Interest, Mahalanobis_measures_with_the_boxs_standard_deviations) {
    const Interest interest = Bar().interest(InterestKind::mahalanobis);
    // The variance of a box along an axis is length^2 / 12, and the tetrahedra fill the box exactly.
    EXPECT_NEAR(interest({4 + 8 / std::sqrt(12), 1, 1}, false), 1.0, 1e-9);
    EXPECT_NEAR(interest({4, 1 + 2 * 2 / std::sqrt(12), 1}, false), 2.0, 1e-9);
}

TEST(Interest, Combined_prefers_the_directions_of_the_bar_at_equal_distance) {
    const Bar bar;
    const Interest interest = bar.interest(InterestKind::combined);
    EXPECT_LT(interest({5.5, 1, 1}, false), interest({4, 2.5, 1}, false));
    EXPECT_LT(interest({2.5, 1, 1}, false), interest({4, 1, -0.5}, false));
    const double distance = bar.interest(InterestKind::distance)({4, 2.5, 1}, false);
    EXPECT_GE(interest({4, 2.5, 1}, false), distance);
    EXPECT_LE(interest({4, 2.5, 1}, false), distance + 0.25);
}

TEST(Interest, Combined_without_weight_is_the_distance) {
    const Bar bar;
    const Point place{6, 0.5, 1.5};
    EXPECT_EQ(bar.interest(InterestKind::combined, 0)(place, true),
              bar.interest(InterestKind::distance)(place, true));
}

TEST(Interest, Direction_ignores_the_distance) {
    const Interest interest = Bar().interest(InterestKind::direction);
    EXPECT_EQ(interest({4 + 1, 1 + 0.1, 1}, false), interest({4 + 3, 1 + 0.3, 1}, false));
    EXPECT_LT(interest({8, 1, 1}, false), interest({4, 1.1, 1}, false));
}

}  // namespace
}  // namespace knead::test
