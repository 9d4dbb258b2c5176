// SPDX-License-Identifier: Apache-2.0
#include "touch/z_width.h"

#include <gtest/gtest.h>

#include "unit/runtime/block_asset.h"

namespace knead::tools::test {
namespace {

using knead::test::cube_asset;

constexpr std::uint32_t kCells = 4;  ///< 384 tetrahedra: a step takes tens of microseconds

/// A light grip on a small desktop device.
ZWidthSetup desktop() {
    ZWidthSetup setup;
    setup.hand.device_mass_kg = 0.045;
    setup.hand.position_resolution_m = 55e-6;
    setup.hand.coulomb_friction_n = 0.05;
    setup.hand.max_force_n = 3.3;
    setup.hold_s = 0.6;
    return setup;
}

Asset soft_cube() {
    return cube_asset(kCells, ToolShape::plate, ToolContact::sticking);
}

TEST(Z_width, Is_the_same_when_measured_twice) {
    const Asset asset = soft_cube();
    ZWidthSetup setup = desktop();
    setup.haptic.mode = HapticMode::two_rate;
    const ZWidthProbe first = probe_stiffness(asset, setup, 300), second = probe_stiffness(asset, setup, 300);
    EXPECT_EQ(first.oscillation_m, second.oscillation_m);
    EXPECT_EQ(first.given_j, second.given_j);
    EXPECT_EQ(first.force_n, second.force_n);
    EXPECT_GT(first.force_n, 0.1) << "it was in contact";
}

TEST(Z_width, Of_a_held_force_is_far_below_that_of_the_synchronous_loop) {
    const Asset asset = soft_cube();
    ZWidthSetup setup = desktop();
    const ZWidth synchronous = find_z_width(asset, setup);
    setup.haptic.mode = HapticMode::two_rate;
    setup.haptic.rendering = LocalRendering::hold;
    setup.latency_periods = 1;
    const ZWidth hold = find_z_width(asset, setup);
    EXPECT_GT(synchronous.stiffness_n_per_m, 200);
    EXPECT_LT(hold.stiffness_n_per_m, 0.5 * synchronous.stiffness_n_per_m);
}

TEST(Z_width, Bounds_its_search_and_its_resolution) {
    const Asset asset = soft_cube();
    ZWidthSetup setup = desktop();
    ZWidthSearch search;
    search.least_n_per_m = 50;
    search.most_n_per_m = 100;
    const ZWidth found = find_z_width(asset, setup, search);
    EXPECT_TRUE(found.at_most);
    EXPECT_EQ(found.stiffness_n_per_m, 100);
    EXPECT_EQ(found.probes, 2);
    search.epsilon_j = -1;  // nothing is good
    const ZWidth none = find_z_width(asset, setup, search);
    EXPECT_EQ(none.stiffness_n_per_m, 0);
    EXPECT_FALSE(none.good.good());
    EXPECT_EQ(none.probes, 1);
}

}  // namespace
}  // namespace knead::tools::test
