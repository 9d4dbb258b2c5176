// SPDX-License-Identifier: Apache-2.0
#include "tune/recipe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tune/mesh_range.h"

namespace knead::tools {
namespace {

TEST(Recipes, Of_all_methods_have_different_texts) {
    std::set<std::string> texts;
    for (const Recipe& recipe : recipes_of({tunable_methods(), {2, 3}, {1, 6}}))
        EXPECT_TRUE(texts.insert(recipe.text()).second) << recipe.text();
}

TEST(Recipes, Of_the_paper_are_all_bins_clusters_orders_and_rules) {
    const auto recipes = recipes_of({{"paper"}, {2, 3}, {1, 3, 6}});
    EXPECT_EQ(recipes.size(), 2u * 3u * 2u * 2u);
    int own = 0;
    for (const Recipe& recipe : recipes)
        own += recipe.is_the_papers() ? 1 : 0;
    EXPECT_EQ(own, 3);  // two bins, stiff first, dominant; k = 1, 3, 6
}

TEST(Recipes, Do_not_offer_what_the_runtime_cannot_run) {
    EXPECT_THAT(tunable_methods(), testing::Not(testing::Contains("kmod09")));
}

MeshSource cubes(std::vector<std::uint32_t> divisions) {
    MeshSource source;
    source.kind = "cubes";
    source.size_m = {0.1};
    source.divisions = std::move(divisions);
    return source;
}

TEST(Mesh_range, Of_cubes_is_every_smaller_number_from_three_on) {
    std::vector<std::uint32_t> found;
    for (const MeshSource& source : coarser_meshes(cubes({10}), 6000))
        found.push_back(source.divisions.at(0));
    EXPECT_THAT(found, testing::ElementsAre(3, 4, 5, 6, 7, 8, 9));
}

TEST(Mesh_range, Of_a_long_box_of_cubes_keeps_its_proportions) {
    for (const MeshSource& source : coarser_meshes(cubes({20, 10, 5}), 6000)) {
        ASSERT_EQ(source.divisions.size(), 3u);
        EXPECT_NEAR(source.divisions[1], source.divisions[0] / 2.0, 0.5);
        EXPECT_NEAR(source.divisions[2], source.divisions[0] / 4.0, 0.5);
    }
}

TEST(Mesh_range, Of_an_outline_asks_for_fewer_tetrahedra_whatever_the_edge_length_was) {
    MeshSource outline;
    outline.kind = "outline";
    outline.edge_length_m = 0.01;
    const auto sources = coarser_meshes(outline, 3000);
    ASSERT_FALSE(sources.empty());
    for (const MeshSource& source : sources) {
        EXPECT_EQ(source.edge_length_m, 0);
        EXPECT_LT(source.target_tetrahedra, 3000u);
    }
}

TEST(Mesh_range, Line_of_a_level_says_what_differs) {
    EXPECT_EQ(level_mesh_toml(cubes({7}), cubes({10})), "{ divisions = [7] }");
    MeshSource other = cubes({7});
    other.size_m = {0.2};
    EXPECT_EQ(level_mesh_toml(other, cubes({10})), "");
}

}  // namespace
}  // namespace knead::tools
