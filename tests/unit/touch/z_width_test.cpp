// SPDX-License-Identifier: Apache-2.0
#include "touch/z_width.h"

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "unit/runtime/block_asset.h"
#include "unit/touch/z_width_setups.h"

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

TEST(Z_width, Of_a_bonded_tool_is_not_charged_with_a_stretched_coupling_at_the_start) {
    const Asset asset = cube_asset(kCells, ToolShape::plate, ToolContact::bonded);
    ZWidthSetup setup = desktop();
    setup.haptic.safety.passivity = false;
    // Stretched by the clearance of 1 mm, it would be given half of 3000 N/m x (1 mm)^2.
    EXPECT_LT(probe_stiffness(asset, setup, 3000).given_j, 0.2 * 0.5 * 3000 * 1e-6);
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

TEST(Z_width, May_ask_for_one_criterion_only) {
    const Asset asset = soft_cube();
    ZWidthSearch search;
    search.most_n_per_m = 50;
    search.epsilon_j = -1;  // nothing is passive
    search.must_be_passive = false;
    EXPECT_EQ(find_z_width(asset, desktop(), search).stiffness_n_per_m, 50);
    search.must_be_passive = true;
    search.must_be_stable = false;
    EXPECT_EQ(find_z_width(asset, desktop(), search).stiffness_n_per_m, 0);
}

/// Three of the twelve set-ups of docs/devices.md, the worst among them.
struct Kept {
    double youngs_modulus_pa;
    const char* device;
    double latency_periods;
    bool of_interest;  ///< only up to where the range of interest ends
};

void PrintTo(const Kept& kept, std::ostream* stream) {
    *stream << kept.device << " " << kept.youngs_modulus_pa << " Pa";
}

class ZWidthKept : public ::testing::TestWithParam<Kept> {};

TEST_P(ZWidthKept, By_the_reduced_object_at_120_Hz_and_by_nothing_less) {
    const Asset asset = measured_cube(GetParam().youngs_modulus_pa);
    const DevicePreset device = find_device(read_devices(KNEAD_DEVICES_FILE), GetParam().device);
    const ZWidthSetup setup = compared_grip(device);
    ZWidthSearch search;
    search.ratio = 1.1;
    if (GetParam().of_interest) search.most_n_per_m = range_of_interest_n_per_m(device);
    const double synchronous = find_z_width(asset, setup, search).stiffness_n_per_m;
    const auto share = [&](LocalRendering rendering) {
        const ZWidthSetup slow = two_rate(setup, rendering, 120, GetParam().latency_periods);
        return find_z_width(asset, slow, search).stiffness_n_per_m / synchronous;
    };
    ASSERT_GT(synchronous, device.max_stiffness_n_per_m.value);
    EXPECT_GE(share(LocalRendering::reduced_object), kKept);
    EXPECT_LT(share(LocalRendering::linear), kKept);
    EXPECT_LT(share(LocalRendering::hold), kKept);
}

INSTANTIATE_TEST_SUITE_P(Setups, ZWidthKept,
                         ::testing::Values(Kept{5.5e3, "touch", 1, false},
                                           Kept{22e3, "phantom_desktop", 1, false},
                                           Kept{88e3, "phantom_desktop", 1, true}),
                         [](const auto& which) {
                             return std::string(which.param.device) + "_" +
                                    std::to_string(static_cast<int>(which.param.youngs_modulus_pa)) + "_Pa";
                         });

}  // namespace
}  // namespace knead::tools::test
