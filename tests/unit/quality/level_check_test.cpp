// SPDX-License-Identifier: Apache-2.0
#include "knead/level_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "unit/runtime/block_asset.h"

namespace knead::tools {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr double kRounding = 1e-9;  // of two direct solves

/// A column of two layers, one on the other, nu 0: the frictionless plate strains each along z alone.
Asset column(double lower_pa, double upper_pa, std::uint32_t cells) {
    Asset asset = test::cube_asset(cells, ToolShape::plate, ToolContact::frictionless, {lower_pa, 0, 1000});
    asset.palette.push_back({upper_pa, 0, 1000});
    for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
        double middle_m = 0;
        for (const std::uint32_t node : asset.tetrahedra[t])
            middle_m += asset.nodes_m[node][2] / 4;
        asset.palette_index[t] = middle_m > 0.05 ? 1 : 0;
    }
    return asset;
}

TEST(LevelCheck, Of_two_layers_for_one_finds_the_error_of_the_mean) {
    // Springs in series: 2 / (1/4 + 1/40) kPa; its volume average is 22 kPa.
    const double series_pa = 2 / (1 / 4e3 + 1 / 40e3);
    LevelCheck check(column(4e3, 40e3, 4));
    const auto found = check.compare(column(22e3, 22e3, 4));
    ASSERT_THAT(found, SizeIs(1));
    EXPECT_EQ(found[0].problem, "");
    EXPECT_NEAR(found[0].force_error, 22e3 / series_pa - 1, kRounding * 22e3 / series_pa);
    EXPECT_NEAR(found[0].mesh_error.value(), 0, kRounding);
    EXPECT_NEAR(found[0].elasticity_error.value(), found[0].force_error, kRounding * found[0].force_error);
}

TEST(LevelCheck, Of_the_same_object_on_another_mesh_finds_no_error_in_what_is_uniform) {
    LevelCheck check(column(4e3, 40e3, 4));
    const auto found = check.compare(column(4e3, 40e3, 2));
    EXPECT_NEAR(found[0].force_error, 0, kRounding);
    EXPECT_FALSE(found[0].mesh_error.has_value());
    const Findings findings = findings_of(found, check.fine(), "coarse");
    ASSERT_THAT(findings, SizeIs(1));
    EXPECT_FALSE(findings[0].warning);
}

TEST(LevelCheck, Tells_the_mesh_from_the_elasticities) {
    const PaletteEntry locking{22e3, 0.49, 1000};
    const Asset fine = test::cube_asset(6, ToolShape::plate, ToolContact::bonded, locking);
    const Asset coarse = test::cube_asset(2, ToolShape::plate, ToolContact::bonded, locking);
    LevelCheck check(fine);
    const auto found = check.compare(coarse);  // of one matter: all is the mesh's
    ASSERT_TRUE(found[0].mesh_error.has_value());
    EXPECT_NEAR(found[0].elasticity_error.value(), 0, kRounding);
    EXPECT_GT(std::abs(*found[0].mesh_error), kLevelForceError);
    const Findings findings = findings_of(found, fine, "coarse");
    EXPECT_TRUE(findings[0].warning);
    EXPECT_THAT(findings[0].advice, HasSubstr("finer mesh"));
}

TEST(LevelCheck, Names_a_stiff_inclusion_in_soft_matter) {
    Asset fine = test::cube_asset(6, ToolShape::plate, ToolContact::bonded, {4e3, 0.3, 1000});
    Asset level = fine;
    fine.palette.push_back({4e6, 0.3, 1000});
    for (std::size_t t = 0; t < fine.tetrahedra.size(); ++t) {
        bool inside = true;
        for (const std::uint32_t node : fine.tetrahedra[t])
            for (const double x : fine.nodes_m[node])
                inside = inside && x > 0.02 && x < 0.08;
        fine.palette_index[t] = inside ? 1 : 0;
    }
    LevelCheck check(fine);
    const Findings findings = findings_of(check.compare(level), fine, "soft");
    EXPECT_TRUE(findings[0].warning);
    EXPECT_LT(findings[0].number, -kLevelForceError);
    EXPECT_THAT(findings[0].text, HasSubstr("a stiff inclusion in soft matter: level soft errs by -"));
}

TEST(LevelCheck, Does_not_call_a_layer_an_inclusion) {
    LevelCheck check(column(4e3, 40e3, 4));
    const Findings findings = findings_of(check.compare(column(22e3, 22e3, 4)), check.fine(), "one");
    EXPECT_THAT(findings[0].text, HasSubstr("stiff and soft matter in a row: level one errs by +"));
}

TEST(LevelCheck, Of_what_cannot_be_compared_says_why) {
    Asset free = test::asset_of(test::kuhn_cube(2), [](const Point&) { return false; });
    free.tools = test::cube_asset(2, ToolShape::plate, ToolContact::bonded).tools;
    free.tools[0].nodes = test::free_nodes(free, test::at_height(0.1));
    EXPECT_EQ(LevelCheck(free).compare(free)[0].problem, "nothing holds the object");
    Asset small = test::cube_asset(2, ToolShape::sphere, ToolContact::sticking);
    small.tools[0].radius_m = 1e-3;
    small.tools[0].rest_position_m = {0.025, 0.025, 0.101};
    EXPECT_THAT(LevelCheck(small).compare(small)[0].problem, HasSubstr("reaches 0 nodes"));
}

}  // namespace
}  // namespace knead::tools
