// SPDX-License-Identifier: Apache-2.0
#include "tune/tune_loads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/error.h"
#include "evaluate/surface_region.h"
#include "support/kuhn_cube.h"

namespace knead::tools {
namespace {

constexpr double kSideM = 0.1;
// Areas are sums of a few hundred cut triangles in double precision.
constexpr double kAreaTolerance = 1e-12;
const Box kCube{{0, 0, 0}, {kSideM, kSideM, kSideM}};

TEST(Tune_loads, Groups_are_their_loads_each_once_in_the_order_of_the_tables) {
    EXPECT_THAT(loads_of({"pads", "press", "pad4"}, "--on"),
                testing::ElementsAre("press10", "press20", "pad4", "pad3", "tip2", "side"));
}

TEST(Tune_loads, Unknown_name_is_bad_usage_with_the_option_and_the_nearest) {
    try {
        (void)loads_of({"padz"}, "--on");
        FAIL() << "accepted";
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_usage);
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("--on"), testing::HasSubstr("pads")));
    }
}

TEST(Tune_loads, Siblings_are_none_of_the_loads_that_they_are_held_out_for) {
    const auto loads = loads_of({"press", "pads"}, "--on");
    const auto siblings = siblings_of(loads);
    EXPECT_THAT(siblings, testing::ElementsAre("press15", "pad4-opposite", "pad3-opposite", "tip2-opposite",
                                               "side-opposite"));
    for (const std::string& sibling : siblings)
        EXPECT_THAT(loads, testing::Not(testing::Contains(sibling)));
    EXPECT_THAT(siblings_of({"shear"}), testing::IsEmpty());
}

TEST(Tune_loads, Opposite_pad_has_the_same_area_elsewhere_and_pushes_into_the_object) {
    const TetMesh mesh = test::kuhn_cube(6);
    for (const char* name : {"pad4", "pad3", "tip2", "side"}) {
        const Load own = named_load(name, kCube);
        const Load opposite = sibling_load(std::string(name) + "-opposite", kCube);
        const MeshedRegion here = mesh_region(mesh, own.region);
        const MeshedRegion there = mesh_region(mesh, opposite.region);
        EXPECT_NEAR(here.area_m2, there.area_m2, kAreaTolerance) << name;
        EXPECT_NE(here.nodes, there.nodes) << name;
        double into = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            into += opposite.region.facing[axis] * opposite.motion.translation_m[axis];
        EXPECT_LT(into, 0) << name;
    }
}

TEST(Tune_loads, Press15_is_between_the_two_presses) {
    const double depth_m = sibling_load("press15", kCube).motion.translation_m[2];
    EXPECT_LT(depth_m, named_load("press10", kCube).motion.translation_m[2]);
    EXPECT_GT(depth_m, named_load("press20", kCube).motion.translation_m[2]);
}

TEST(Tune_loads, Order_of_difficulty_loses_none) {
    const auto loads = loads_of({"all", "scene"}, "--on");
    EXPECT_THAT(hardest_first(loads), testing::UnorderedElementsAreArray(loads));
}

}  // namespace
}  // namespace knead::tools
