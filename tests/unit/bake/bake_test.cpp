// SPDX-License-Identifier: Apache-2.0
#include "bake/bake.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "common/error.h"
#include "support/kuhn_cube.h"

namespace knead::tools {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kCells = 3;

/// A cube whose left tetrahedra are soft and right ones stiff.
MaterialObject two_halves() {
    MaterialObject object;
    object.mesh = test::kuhn_cube(kCells);
    for (std::size_t i = 0; i < object.mesh.tetrahedra.size(); ++i) {
        const bool soft = barycentre_m(object.mesh, i)[0] < 0.05;
        object.material.youngs_modulus_pa.push_back(soft ? 4000 : 40000);
        object.material.poissons_ratio.push_back(soft ? 0.3 : 0.4);
        object.material.density_kg_per_m3.push_back(1000);
    }
    return object;
}

Selection side(const std::string& name, std::uint32_t line) {
    Selection selection;
    selection.side = name;
    selection.scene_key = "held[0]";
    selection.line = line;
    return selection;
}

Scene press_scene() {
    Scene scene;
    scene.file = "cube.toml";
    scene.name = "cube";
    scene.held.push_back(side("bottom", 11));
    SceneTool press;
    press.name = "press";
    press.touches = side("top", 12);
    press.touches.scene_key = "tool[0].touches";
    press.line = 10;
    scene.tools.push_back(press);
    scene.levels.emplace_back();
    scene.levels.back().name = "fine";
    return scene;
}

TEST(Bake, Puts_free_nodes_first_and_held_nodes_last) {
    const Asset asset = bake(press_scene(), press_scene().levels[0], two_halves());
    ASSERT_EQ(asset.nodes_m.size(), 64u);
    EXPECT_EQ(asset.free_node_count, 48u);
    for (std::size_t i = 0; i < asset.nodes_m.size(); ++i)
        EXPECT_EQ(asset.nodes_m[i][2] == 0, i >= 48) << i;
}

TEST(Bake, Keeps_every_tetrahedron_with_its_place_and_elasticity) {
    const MaterialObject object = two_halves();
    const Asset asset = bake(press_scene(), press_scene().levels[0], object);
    std::map<Point, double> by_place;  // barycentres are exact sums of the same numbers in another order
    const auto rounded = [](const Point& p) {
        return Point{std::round(p[0] * 1e9), std::round(p[1] * 1e9), std::round(p[2] * 1e9)};
    };
    for (std::size_t i = 0; i < object.mesh.tetrahedra.size(); ++i)
        by_place[rounded(barycentre_m(object.mesh, i))] = object.material.youngs_modulus_pa[i];
    TetMesh baked;
    baked.nodes_m = asset.nodes_m;
    baked.tetrahedra = asset.tetrahedra;
    ASSERT_EQ(baked.tetrahedra.size(), object.mesh.tetrahedra.size());
    EXPECT_EQ(asset.palette.size(), 2u);
    for (std::size_t i = 0; i < baked.tetrahedra.size(); ++i) {
        EXPECT_GT(signed_volume_m3(baked, i), 0);
        EXPECT_EQ(asset.palette[asset.palette_index[i]].youngs_modulus_pa,
                  by_place.at(rounded(barycentre_m(baked, i))));
    }
}

TEST(Bake, Leaves_out_tetrahedra_that_cannot_move_and_their_nodes) {
    Scene scene = press_scene();
    scene.held[0].side.clear();
    scene.held[0].box_m = {Point{0, 0, 0}, Point{0.1, 0.1, 0.07}};  // two of three layers
    const Asset asset = bake(scene, scene.levels[0], two_halves());
    EXPECT_EQ(asset.tetrahedra.size(), 6u * 9u);
    EXPECT_EQ(asset.nodes_m.size(), 32u);
    EXPECT_EQ(asset.free_node_count, 16u);
}

TEST(Bake, Lets_a_tool_touch_free_surface_nodes_only) {
    Scene scene = press_scene();
    scene.tools[0].touches.side = "all";
    const Asset asset = bake(scene, scene.levels[0], two_halves());
    const auto& nodes = asset.tools[0].nodes;
    EXPECT_EQ(nodes.size(), 64u - 16u - 8u);  // without the held bottom and the 2 x 2 x 2 inner nodes
    EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end()));
    EXPECT_LT(nodes.back(), asset.free_node_count);
}

TEST(Bake, Puts_a_tool_without_position_on_the_highest_of_its_nodes) {
    Scene scene = press_scene();
    scene.tools[0].shape = ToolShape::sphere;
    scene.tools[0].contact = ToolContact::frictionless;
    scene.tools[0].radius_m = 0.02;
    const Point position = bake(scene, scene.levels[0], two_halves()).tools[0].rest_position_m;
    EXPECT_NEAR(position[0], 0.05, 1e-12);
    EXPECT_NEAR(position[1], 0.05, 1e-12);
    EXPECT_NEAR(position[2], 0.12, 1e-12);
}

TEST(Bake, Puts_a_capsule_without_position_on_the_highest_of_its_nodes_whatever_its_orientation) {
    constexpr double kTop = 0.1, kRadius = 0.02, kHalfLength = 0.05;
    constexpr double kRounding = 1e-12;  // of a few additions of tenths
    const double root = std::sqrt(0.5);
    const std::pair<std::array<double, 4>, double> cases[] = {
        {{1, 0, 0, 0}, kTop + kRadius + kHalfLength},                                           // upright
        {{0, 1, 0, 0}, kTop + kRadius + kHalfLength},                                           // upside down
        {{root, 0, root, 0}, kTop + kRadius},                                                   // lying
        {{std::cos(M_PI / 6), std::sin(M_PI / 6), 0, 0}, kTop + kRadius + 0.5 * kHalfLength}};  // 60 degrees
    for (const auto& [orientation, height] : cases) {
        Scene scene = press_scene();
        SceneTool& tool = scene.tools[0];
        tool.shape = ToolShape::capsule;
        tool.contact = ToolContact::coulomb;
        tool.radius_m = kRadius;
        tool.half_length_m = kHalfLength;
        tool.friction_coefficient = 0.3;
        tool.orientation_wxyz = orientation;
        const ToolSet baked = bake(scene, scene.levels[0], two_halves()).tools[0];
        EXPECT_NEAR(baked.rest_position_m[0], 0.05, kRounding);
        EXPECT_NEAR(baked.rest_position_m[2], height, kRounding);
        EXPECT_EQ(baked.half_length_m, kHalfLength);
        EXPECT_EQ(baked.friction_coefficient, 0.3);
    }
}

TEST(Bake, Writes_only_what_the_scene_asks_for) {
    Scene scene = press_scene();
    const Asset plain = bake(scene, scene.levels[0], two_halves());
    EXPECT_TRUE(plain.surface.triangles.empty());
    EXPECT_EQ(plain.requests.size(), 3u);  // mesh, material, tool
    scene.needs_surface = true;
    scene.surface_line = 20;
    scene.gravity_m_per_s2 = {0, 0, -9.81};
    scene.gravity_line = 21;
    const Asset full = bake(scene, scene.levels[0], two_halves());
    EXPECT_EQ(full.surface.triangles.size(), 6u * 9u * 2u);
    ASSERT_EQ(full.requests.size(), 5u);
    EXPECT_EQ(full.requests[3].group, "/knead/asset/gravity");
    EXPECT_EQ(full.requests[3].scene_line, 21u);
    EXPECT_EQ(full.requests[4].scene_key, "app.surface");
}

TEST(Bake, Ties_a_skin_to_the_tetrahedra_of_the_asset_and_leaves_the_rest_still) {
    Scene scene = press_scene();
    scene.held[0].side.clear();
    scene.held[0].box_m = {Point{0, 0, 0}, Point{0.1, 0.1, 0.04}};  // the lowest of three layers
    scene.embedding = EmbeddingSource{};
    scene.embedding->line = 30;
    Skin skin;
    skin.vertices_m = {{0.02, 0.03, 0.01}, {0.06, 0.05, 0.05}, {0.04, 0.08, 0.102}};
    skin.triangles = {{0, 1, 2}};
    const Asset asset = bake(scene, scene.levels[0], two_halves(), skin);
    ASSERT_EQ(asset.tetrahedra.size(), 6u * 9u * 2u);
    ASSERT_EQ(asset.embedding.tetrahedron.size(), 2u);
    EXPECT_EQ(asset.embedding.still_vertices_m, std::vector<Point>{skin.vertices_m[0]});
    EXPECT_EQ(asset.embedding.triangles[0], (std::array<std::uint32_t, 3>{2, 0, 1}));
    for (std::size_t v = 0; v < 2; ++v) {
        Point position{};
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                position[axis] += asset.embedding.weights[v][k] *
                                  asset.nodes_m[asset.tetrahedra[asset.embedding.tetrahedron[v]][k]][axis];
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(position[axis], skin.vertices_m[v + 1][axis], 1e-7);  // float weights
    }
    EXPECT_EQ(asset.requests.back().group, "/knead/asset/embedding");
    EXPECT_EQ(asset.requests.back().scene_line, 30u);
    skin.vertices_m[2][2] = 0.2;
    try {
        (void)bake(scene, scene.levels[0], two_halves(), skin);
        FAIL() << "a vertex 10 cm outside was accepted";
    } catch (const ToolError& error) {
        EXPECT_THAT(error.what(),
                    HasSubstr("cube.toml:30: embedding: 1 of 3 vertices lie more than 0.005 m"));
    }
}

TEST(Bake, Without_held_nodes_is_a_free_body) {
    Scene scene = press_scene();
    scene.held.clear();
    const Asset asset = bake(scene, scene.levels[0], two_halves());
    EXPECT_EQ(asset.free_node_count, asset.nodes_m.size());
}

std::string error_of(const Scene& scene) {
    try {
        (void)bake(scene, scene.levels[0], two_halves());
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        return error.what();
    }
    return "no error";
}

TEST(Bake, Of_a_selection_without_nodes_names_its_line) {
    Scene scene = press_scene();
    scene.held[0].box_m = {Point{1, 1, 1}, Point{2, 2, 2}};
    EXPECT_THAT(error_of(scene), HasSubstr("cube.toml:11: held[0] selects no node"));
    scene = press_scene();
    scene.tools[0].touches.side = "bottom";
    EXPECT_THAT(error_of(scene), HasSubstr("cube.toml:12: tool[0].touches selects no node"));
    scene = press_scene();
    scene.held[0].side = "all";
    EXPECT_THAT(error_of(scene), HasSubstr("nothing can move"));
}

}  // namespace
}  // namespace knead::tools
