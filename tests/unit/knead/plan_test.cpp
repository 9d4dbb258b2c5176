// SPDX-License-Identifier: Apache-2.0
#include "knead/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "common/error.h"

namespace knead::tools {
namespace {

Scene scene_with_levels() {
    Scene scene;
    scene.file = "steak.toml";
    scene.name = "steak";
    scene.mesh.kind = "cubes";
    scene.mesh.size_m = {0.1};
    scene.mesh.divisions = {10};
    scene.material.scenario = 2;
    scene.levels.resize(3);
    scene.levels[0].name = "fine";
    for (std::size_t i : {1, 2}) {
        scene.levels[i].bins = 2;
        scene.levels[i].mesh = scene.mesh;
        scene.levels[i].mesh->divisions = {6};
    }
    scene.levels[1].name = "k1";
    scene.levels[1].clusters = 1;
    scene.levels[2].name = "k3";
    scene.levels[2].clusters = 3;
    return scene;
}

std::vector<std::string> tools_of(const Plan& plan) {
    std::vector<std::string> tools;
    for (const Stage& stage : plan.stages)
        tools.push_back(stage.tool);
    return tools;
}

TEST(Plan, Of_a_raw_level_goes_from_mesh_and_material_to_the_asset) {
    const Plan plan = plan_build(scene_with_levels(), {"fine"}, "out");
    EXPECT_THAT(tools_of(plan), testing::ElementsAre("knead-mesh", "knead-material", "knead-bake"));
    EXPECT_EQ(plan.assets.at(0).file, "out/steak.fine.hdf");
}

TEST(Plan, Of_two_levels_on_the_same_coarse_mesh_makes_it_and_its_overlap_once) {
    const Plan plan = plan_build(scene_with_levels(), {}, "out");
    const auto tools = tools_of(plan);
    EXPECT_EQ(std::count(tools.begin(), tools.end(), "knead-mesh"), 2);
    EXPECT_EQ(std::count(tools.begin(), tools.end(), "knead-overlap"), 1);
    EXPECT_EQ(std::count(tools.begin(), tools.end(), "knead-coarsen"), 2);
    EXPECT_EQ(plan.assets.size(), 3u);
}

TEST(Plan, Makes_every_stage_file_before_it_is_read_and_no_file_twice) {
    const Plan plan = plan_build(scene_with_levels(), {}, "out");
    std::set<std::string> made;
    for (const Stage& stage : plan.stages) {
        for (const std::string& argument : stage.arguments) {
            const bool is_input = argument.rfind("out/", 0) == 0 && argument != stage.output.string();
            if (is_input) {
                EXPECT_EQ(made.count(argument), 1u) << stage.tool << " reads " << argument;
            }
        }
        EXPECT_TRUE(made.insert(stage.output.string()).second) << stage.output;
    }
}

TEST(Plan, Of_an_unknown_level_is_bad_usage_with_the_nearest_name) {
    try {
        (void)plan_build(scene_with_levels(), {"fnie"}, "out");
        FAIL() << "accepted";
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_usage);
        EXPECT_THAT(error.what(), testing::HasSubstr("did you mean \"fine\"?"));
    }
}

}  // namespace
}  // namespace knead::tools
