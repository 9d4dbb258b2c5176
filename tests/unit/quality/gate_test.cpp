// SPDX-License-Identifier: Apache-2.0
#include "quality/gate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "unit/runtime/block_asset.h"

namespace knead::tools {
namespace {

using testing::IsEmpty;
using testing::UnorderedElementsAre;

Asset pressed_cube(ToolShape shape = ToolShape::plate, ToolContact contact = ToolContact::bonded) {
    return test::cube_asset(4, shape, contact);
}

/// Cells of 12.5 mm under a ball of 40 mm.
Asset cube_under_a_ball() {
    return test::cube_asset(8, ToolShape::sphere, ToolContact::frictionless);
}

std::vector<std::string> warnings(const Asset& asset) {
    std::vector<std::string> ids;
    for (const Finding& finding : examine(asset).findings)
        if (finding.warning) ids.push_back(finding.id);
    return ids;
}

double number_of(const Asset& asset, const std::string& id) {
    for (const Finding& finding : examine(asset).findings)
        if (finding.id == id) return finding.number;
    return NAN;
}

Asset scaled(Asset asset, double factor) {
    for (Point& node : asset.nodes_m)
        for (double& x : node)
            x *= factor;
    for (ToolSet& tool : asset.tools)
        for (double& x : tool.rest_position_m)
            x *= factor;
    return asset;
}

Asset changed(const std::function<void(Asset&)>& change, Asset asset = pressed_cube()) {
    change(asset);
    return asset;
}

TEST(Gate, Has_nothing_to_say_against_the_papers_press_or_a_ball_on_a_fine_cube) {
    EXPECT_THAT(warnings(pressed_cube()), IsEmpty());
    EXPECT_THAT(warnings(cube_under_a_ball()), IsEmpty());
    EXPECT_THAT(warnings(pressed_cube(ToolShape::plate, ToolContact::sticking)), IsEmpty());
}

TEST(Gate, Of_millimetres_called_metres_says_so) {
    const Asset asset = scaled(pressed_cube(), 1000);
    EXPECT_THAT(warnings(asset), UnorderedElementsAre("size-large", "mass-odd"));
    EXPECT_NEAR(number_of(asset, "size-large"), 100, 1e-9);
    EXPECT_NEAR(number_of(asset, "mass-odd"), 1e9, 1);
    EXPECT_THAT(warnings(scaled(pressed_cube(), 1e-4)), UnorderedElementsAre("size-small", "mass-odd"));
}

TEST(Gate, Of_matter_in_other_units_says_so) {
    EXPECT_THAT(warnings(changed([](Asset& a) { a.palette[0].youngs_modulus_pa = 22; })),
                UnorderedElementsAre("youngs-modulus-low"));
    EXPECT_THAT(warnings(changed([](Asset& a) { a.palette[0].youngs_modulus_pa = 22e12; })),
                UnorderedElementsAre("youngs-modulus-high"));
    EXPECT_THAT(warnings(changed([](Asset& a) { a.palette[0].density_kg_per_m3 = 1; })),
                UnorderedElementsAre("density-odd"));
}

TEST(Gate, Of_matter_that_cannot_stand_says_that_it_sags) {
    const auto heavy = [](Asset& a) {
        a.palette[0].youngs_modulus_pa = 2000;
        a.gravity_m_per_s2 = {0, 0, -9.81};
    };
    const Asset asset = changed(heavy);
    EXPECT_THAT(warnings(asset), UnorderedElementsAre("sags"));
    EXPECT_NEAR(number_of(asset, "sags"), 1000 * 9.81 * 0.1 / 2000, 1e-9);
    EXPECT_THAT(warnings(changed([](Asset& a) { a.gravity_m_per_s2 = {0, 0, -9.81}; })), IsEmpty());
}

TEST(Gate, Of_nearly_incompressible_matter_says_that_it_locks) {
    EXPECT_THAT(warnings(changed([](Asset& a) { a.palette[0].poissons_ratio = 0.49; })),
                UnorderedElementsAre("locks"));
    EXPECT_THAT(warnings(changed([](Asset& a) { a.palette[0].poissons_ratio = 0.45; })), IsEmpty());
}

TEST(Gate, Of_a_contrast_beyond_the_tested_says_so) {
    Asset asset = pressed_cube();
    asset.palette = {{100, 0.3, 1000}, {2e11, 0.3, 1000}};
    asset.palette_index[5] = 1;
    EXPECT_THAT(warnings(asset), UnorderedElementsAre("contrast"));
}

TEST(Gate, Of_a_sliver_names_it) {
    Asset asset = pressed_cube();
    const Tetrahedron t = asset.tetrahedra[7];
    Point middle{};
    for (std::size_t k = 1; k < 4; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            middle[axis] += asset.nodes_m[t[k]][axis] / 3;
    for (std::size_t axis = 0; axis < 3; ++axis)  // nearly into the opposite face
        asset.nodes_m[t[0]][axis] += 0.995 * (middle[axis] - asset.nodes_m[t[0]][axis]);
    ASSERT_GT(
        signed_volume_m3(asset.nodes_m[t[0]], asset.nodes_m[t[1]], asset.nodes_m[t[2]], asset.nodes_m[t[3]]),
        0);
    const Findings findings = examine_shapes(asset, examine(asset).mesh);
    ASSERT_GE(findings.size(), 2u);
    EXPECT_EQ(findings[0].id, "sliver");
    EXPECT_EQ(findings[1].id, "nearly-inverted");
}

TEST(Gate, Of_a_part_that_nothing_holds_counts_it) {
    Asset asset = pressed_cube();
    const auto first = static_cast<std::uint32_t>(asset.nodes_m.size());
    for (const Point& p : {Point{0.2, 0, 0}, Point{0.22, 0, 0}, Point{0.2, 0.02, 0}, Point{0.2, 0, 0.02}})
        asset.nodes_m.push_back(p);
    asset.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
    asset.palette_index.push_back(0);
    EXPECT_EQ(number_of(asset, "disconnected-parts"), 2);
}

TEST(Gate, Of_edges_of_very_different_lengths_tells_the_ratio) {
    Asset asset = pressed_cube();
    const Tetrahedron t = asset.tetrahedra[0];
    for (std::size_t axis = 0; axis < 3; ++axis)  // a needle: one edge shrinks to 1e-4 of itself
        asset.nodes_m[t[0]][axis] =
            asset.nodes_m[t[1]][axis] + 1e-4 * (asset.nodes_m[t[0]][axis] - asset.nodes_m[t[1]][axis]);
    EXPECT_GT(number_of(asset, "grading"), 1e4);
    EXPECT_TRUE(std::isnan(number_of(pressed_cube(), "grading")));
}

TEST(Gate, Of_an_object_that_nothing_holds_informs_without_a_warning) {
    Asset asset = test::asset_of(test::kuhn_cube(4), [](const Point&) { return false; });
    asset.tools = pressed_cube().tools;
    asset.tools[0].nodes = test::free_nodes(asset, test::at_height(0.1));
    EXPECT_THAT(warnings(asset), IsEmpty());
    EXPECT_EQ(number_of(asset, "free-floating"), 0);
}

TEST(Gate, Of_an_object_held_on_a_line_says_that_it_swings) {
    const TetMesh mesh = test::kuhn_cube(4);
    const auto on_edge = [](const Point& p) { return p[1] == 0 && p[2] == 0; };
    Asset asset = test::asset_of(mesh, on_edge);
    asset.tools = pressed_cube().tools;
    asset.tools[0].nodes = test::free_nodes(asset, test::at_height(0.1));
    EXPECT_THAT(warnings(asset), UnorderedElementsAre("barely-held"));
}

TEST(Gate, Of_a_ball_smaller_than_two_edges_says_so) {
    Asset asset = cube_under_a_ball();
    asset.tools[0].radius_m = 0.01;
    asset.tools[0].rest_position_m[2] = 0.11;
    EXPECT_THAT(warnings(asset), UnorderedElementsAre("tool-small"));
    EXPECT_NEAR(number_of(asset, "tool-small"), 0.02 / 0.0125, 1e-9);
}

TEST(Gate, Of_a_plate_that_passes_beside_the_object_says_how_far) {
    Asset asset = pressed_cube(ToolShape::plate, ToolContact::frictionless);
    asset.tools[0].half_extents_m = {0.05, 0.05};
    EXPECT_THAT(warnings(asset), IsEmpty());
    asset.tools[0].rest_position_m[0] = 0.17;  // its edge at 0.12, the object ends at 0.1
    EXPECT_THAT(warnings(asset), UnorderedElementsAre("tool-misses"));
    EXPECT_NEAR(number_of(asset, "tool-misses"), 0.02, 1e-12);
}

TEST(Gate, Of_tools_that_start_inside_or_far_away_says_so) {
    Asset asset = cube_under_a_ball();
    asset.tools[0].rest_position_m[2] -= 0.004;
    EXPECT_THAT(warnings(asset), UnorderedElementsAre("tool-starts-inside"));
    EXPECT_NEAR(number_of(asset, "tool-starts-inside"), 0.004, 1e-12);
    asset.tools[0].rest_position_m[2] = 120;  // 120 mm
    EXPECT_THAT(warnings(asset), UnorderedElementsAre("tool-far"));
    Asset bonded = pressed_cube();
    bonded.tools[0].rest_position_m[2] = 100;
    EXPECT_THAT(warnings(bonded), UnorderedElementsAre("tool-far"));
}

TEST(Gate, Of_a_tool_without_nodes_says_that_it_touches_nothing) {
    EXPECT_THAT(warnings(changed([](Asset& a) { a.tools[0].nodes.clear(); },
                                 pressed_cube(ToolShape::plate, ToolContact::frictionless))),
                UnorderedElementsAre("tool-touches-nothing"));
}

TEST(Gate, Of_too_many_tetrahedra_says_that_a_step_is_slow) {
    EXPECT_THAT(warnings(test::cube_asset(20, ToolShape::plate, ToolContact::bonded)),
                UnorderedElementsAre("step-slow"));
}

TEST(Gate, Puts_warnings_first) {
    const QualityReport report = examine(scaled(pressed_cube(), 1000));
    ASSERT_GT(report.findings.size(), report.warning_count());
    for (std::size_t k = 0; k < report.findings.size(); ++k)
        EXPECT_EQ(report.findings[k].warning, k < report.warning_count());
}

}  // namespace
}  // namespace knead::tools
