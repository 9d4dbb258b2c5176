// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "mesh/surface.h"
#include "unit/mesh/samples.h"

namespace knead::tools {
namespace {

using namespace test;

TEST(Surface, Of_a_cube_is_the_same_from_every_format) {
    const TriangleSurface surfaces[] = {read_stl_text(cube_stl(0, 2)), read_stl_binary(cube_stl_binary(0, 2)),
                                        read_ply(cube_ply(0, 2)), read_ply(cube_ply_binary(0, 2, false)),
                                        read_ply(cube_ply_binary(0, 2, true))};
    for (const TriangleSurface& surface : surfaces) {
        EXPECT_EQ(surface.points.size(), 8U);
        EXPECT_EQ(surface.triangles.size(), 12U);
        const std::set<Point> corners(surface.points.begin(), surface.points.end());
        EXPECT_TRUE(corners.count({2, 2, 2}) == 1 && corners.count({0, 0, 2}) == 1);
        EXPECT_EQ(require_closed(surface).bodies.size(), 1U);
    }
}

TEST(Surface, With_a_hole_is_refused_with_the_number_and_place_of_its_open_edges) {
    KNEAD_EXPECT_REFUSAL(require_closed(read_stl_text(cube_stl(0, 1, 1))), bad_input,
                         "3 open edges, the first at (1, 1, 0)");
    KNEAD_EXPECT_REFUSAL(require_closed(read_stl_text(cube_stl(0, 1, 2))), bad_input, "4 open edges");
}

TEST(Surface, With_an_inner_wall_is_refused) {
    TriangleSurface surface = read_stl_text(cube_stl(0, 1));
    surface.triangles.push_back({0, 1, 2});  // points in order of first use
    surface.triangles.push_back({0, 2, 1});
    KNEAD_EXPECT_REFUSAL(require_closed(surface), bad_input, "more than two triangles");
}

TEST(Surface, Inside_another_is_a_cavity_and_beside_it_a_body) {
    const std::string hollow = cube_stl(0, 10) + cube_stl(4, 6);
    const ClosedSurface one = require_closed(read_stl_text(hollow));
    EXPECT_EQ(one.bodies, (std::vector<std::vector<std::uint32_t>>{{0, 1}}));
    const ClosedSurface nested =
        require_closed(read_stl_text(cube_stl(4, 6) + cube_stl(4.5, 5.5) + cube_stl(0, 10)));
    EXPECT_EQ(nested.bodies, (std::vector<std::vector<std::uint32_t>>{{1}, {2, 0}}));
    const ClosedSurface two = require_closed(read_stl_text(cube_stl(0, 1) + cube_stl(2, 3)));
    EXPECT_EQ(two.bodies, (std::vector<std::vector<std::uint32_t>>{{0}, {1}}));
}

TEST(Surface, Triangles_with_a_repeated_corner_are_left_out_and_told) {
    const TriangleSurface surface =
        join_corners({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-0.0, 0, 0}, {0, 1, 0}});
    EXPECT_EQ(surface.triangles.size(), 1U);
    ASSERT_EQ(surface.notes.size(), 1U);
    EXPECT_NE(surface.notes[0].text.find("1 triangles"), std::string::npos);
}

TEST(Surface, Text_that_is_no_triangle_is_refused_with_its_line) {
    std::string script = cube_stl(0, 1);
    KNEAD_EXPECT_REFUSAL(read_stl_text(script + "SystemCall \"touch /tmp/x\";\n"), bad_input,
                         "\"SystemCall\"");
    script.replace(script.find("vertex"), 6, "vortex");
    KNEAD_EXPECT_REFUSAL(read_stl_text(script), bad_input, "line 4");
    std::string not_finite = cube_stl(0, 1);
    not_finite.replace(not_finite.find("vertex 0.000000"), 15, "vertex nan");
    KNEAD_EXPECT_REFUSAL(read_stl_text(not_finite), bad_input, "not finite");
    KNEAD_EXPECT_REFUSAL(read_stl_text("solid empty\nendsolid\n"), bad_input, "no triangles");
}

TEST(Surface, Ply_prefixes_and_bad_indices_are_refused) {
    const std::string binary = cube_ply_binary(0, 1, false);
    for (std::size_t size = 0; size < binary.size(); ++size)
        EXPECT_THROW((void)read_ply(binary.substr(0, size)), ToolError) << size;
    EXPECT_THROW((void)read_ply(binary + "x"), ToolError);
    std::string text = cube_ply(0, 1);
    text.replace(text.rfind("4 1 3 7 5"), 9, "4 1 3 8 5");
    KNEAD_EXPECT_REFUSAL(read_ply(text), bad_input, "vertex 8 of 8");
    KNEAD_EXPECT_REFUSAL(read_ply("ply\nformat ascii 1.0\nelement vertex 1000000000000\n"), bad_input,
                         "too short");
}

}  // namespace
}  // namespace knead::tools
