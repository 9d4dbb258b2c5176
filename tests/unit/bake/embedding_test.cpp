// SPDX-License-Identifier: Apache-2.0
#include "bake/embedding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/error.h"
#include "support/kuhn_cube.h"

namespace knead::tools {
namespace {

using testing::HasSubstr;

constexpr double kSide = 0.1;
/// Float weights of the size 10 on coordinates of 0.1 m.
constexpr double kFloatWeightError_m = 1e-6;
/// A point on a face may be outside of both its tetrahedra by rounding.
constexpr double kRoundingVolume_m3 = 1e-18;

/// Points all around a cube and inside it, at most `margin_m` outside.
Skin points_around_the_cube(std::size_t count, double margin_m) {
    std::mt19937_64 random(4);
    Skin skin;
    const auto coordinate = [&] {
        return -margin_m + (kSide + 2 * margin_m) * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const double x = coordinate(), y = coordinate();
        skin.vertices_m.push_back({x, y, coordinate()});
    }
    skin.triangles = {{0, 1, 2}};
    return skin;
}

Point moved(const SurfaceEmbedding& embedding, std::size_t vertex, const CarrierMesh& mesh,
            const std::vector<Point>& nodes_m) {
    Point position{};
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            position[axis] += embedding.weights[vertex][k] *
                              nodes_m[mesh.tetrahedra[embedding.tetrahedron[vertex]][k]][axis];
    return position;
}

/// Negative when `point` is outside: the smallest volume that it spans with a face.
double depth_m3(const CarrierMesh& mesh, std::uint32_t tetrahedron, const Point& point) {
    double least = INFINITY;
    for (std::size_t k = 0; k < 4; ++k) {
        std::array<Point, 4> corners;
        for (std::size_t i = 0; i < 4; ++i)
            corners[i] = i == k ? point : mesh.nodes_m[mesh.tetrahedra[tetrahedron][i]];
        least = std::min(least, signed_volume_m3(corners[0], corners[1], corners[2], corners[3]));
    }
    return least;
}

TEST(Embedding, Puts_each_vertex_into_the_tetrahedron_that_holds_its_nearest_point) {
    const TetMesh cube = test::kuhn_cube(5);
    const CarrierMesh mesh{cube.nodes_m, cube.tetrahedra, cube.tetrahedra.size()};
    const Skin skin = points_around_the_cube(500, 0.02);
    const SurfaceEmbedding embedding = embed(skin, mesh, {"skin", 0.04});
    ASSERT_EQ(embedding.tetrahedron.size(), skin.vertices_m.size());
    EXPECT_TRUE(embedding.still_vertices_m.empty());
    for (std::size_t v = 0; v < skin.vertices_m.size(); ++v) {
        Point nearest = skin.vertices_m[v];  // of a cube: each coordinate clamped
        for (double& x : nearest)
            x = std::clamp(x, 0.0, kSide);
        EXPECT_GE(depth_m3(mesh, embedding.tetrahedron[v], nearest), -kRoundingVolume_m3) << v;
    }
}

TEST(Embedding, Follows_every_affine_motion_of_the_nodes_inside_and_outside) {
    const TetMesh cube = test::kuhn_cube(4);
    const CarrierMesh mesh{cube.nodes_m, cube.tetrahedra, cube.tetrahedra.size()};
    const Skin skin = points_around_the_cube(300, 0.02);
    const SurfaceEmbedding embedding = embed(skin, mesh, {"skin", 0.04});
    const auto map = [](const Point& p) {
        return Point{1.1 * p[0] - 0.3 * p[1] + 0.02, 0.2 * p[0] + 0.9 * p[1] + 0.1 * p[2],
                     0.8 * p[2] - 0.1 * p[0] - 0.05};
    };
    std::vector<Point> nodes_m;
    for (const Point& node : cube.nodes_m)
        nodes_m.push_back(map(node));
    for (std::size_t v = 0; v < skin.vertices_m.size(); ++v) {
        const Point at_rest = moved(embedding, v, mesh, cube.nodes_m),
                    then = moved(embedding, v, mesh, nodes_m);
        const Point expected = map(skin.vertices_m[v]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(at_rest[axis], skin.vertices_m[v][axis], kFloatWeightError_m) << v;
            EXPECT_NEAR(then[axis], expected[axis], kFloatWeightError_m) << v;
        }
    }
}

/// Two cubes of 6 tetrahedra, one on the other; only the upper one moves.
struct Tower {
    TetMesh mesh = test::kuhn_box(1, 1, 2, {kSide, kSide, 2 * kSide});
    CarrierMesh carrier{mesh.nodes_m, {}, 6};

    Tower() {
        for (const bool upper : {true, false})
            for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
                if ((barycentre_m(mesh, t)[2] > kSide) == upper)
                    carrier.tetrahedra.push_back(mesh.tetrahedra[t]);
    }
};

TEST(Embedding, Leaves_vertices_of_the_part_that_cannot_move_where_they_are) {
    const Tower tower;
    Skin skin;
    skin.vertices_m = {{0.05, 0.04, 0.02},      // deep in the part that stands still
                       {0.05, 0.04, 0.18},      // in the part that moves
                       {-0.001, 0.04, 0.05},    // beside the lower part
                       {0.03, 0.06, kSide},     // on the face between the two: moves
                       {0.05, -0.001, 0.199}};  // beside the upper part
    skin.triangles = {{0, 1, 2}, {4, 3, 2}};
    const SurfaceEmbedding embedding = embed(skin, tower.carrier, {"skin", 0});
    ASSERT_EQ(embedding.tetrahedron.size(), 3U);
    EXPECT_EQ(embedding.still_vertices_m, (std::vector<Point>{skin.vertices_m[0], skin.vertices_m[2]}));
    for (const std::uint32_t t : embedding.tetrahedron)
        EXPECT_LT(t, 6U);
    // Moving ones first: 1, 3, 4 -> 0, 1, 2; then the still ones: 0, 2 -> 3, 4.
    EXPECT_EQ(embedding.triangles, (std::vector<std::array<std::uint32_t, 3>>{{3, 0, 4}, {2, 1, 4}}));
}

std::string error_of(const Skin& skin, const CarrierMesh& mesh, double max_distance_m) {
    try {
        (void)embed(skin, mesh, {"a.toml:7: embedding", max_distance_m});
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        return error.what();
    }
    return "no error";
}

TEST(Embedding, Of_vertices_far_outside_names_them) {
    const TetMesh cube = test::kuhn_cube(2);
    const CarrierMesh mesh{cube.nodes_m, cube.tetrahedra, cube.tetrahedra.size()};
    Skin skin;
    skin.vertices_m = {{0.05, 0.05, 0.106}, {0.05, 0.05, 0.104}, {0.05, 0.05, 0.12}};
    skin.triangles = {{0, 1, 2}};
    EXPECT_EQ(
        error_of(skin, mesh, 0),  // 5 % of 0.1 m
        "a.toml:7: embedding: 2 of 3 vertices lie more than 0.005 m outside of the mesh (vertices 0, 2), the "
        "farthest 0.02 m: is the length unit right?");
    EXPECT_THAT(error_of(skin, mesh, 0.01), HasSubstr("1 of 3 vertices lie more than 0.01 m outside"));
    EXPECT_EQ(error_of(skin, mesh, 0.03), "no error");
    skin.vertices_m.assign(9, {0.05, 0.05, 0.2});
    EXPECT_THAT(error_of(skin, mesh, 0.03), HasSubstr("9 of 9"));
    EXPECT_THAT(error_of(skin, mesh, 0.03), HasSubstr("(vertices 0, 1, 2, 3, 4, ...)"));
}

TEST(Embedding, Of_vertices_far_outside_of_a_thin_tetrahedron_names_them) {
    const std::vector<Point> nodes_m{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0.02, 0.02, 1e-4}};
    const CarrierMesh mesh{nodes_m, {{0, 1, 2, 3}}, 1};
    Skin skin;
    skin.vertices_m = {{0.02, 0.02, 5e-5}, {0.02, 0.02, -2e-3}, {0.03, 0.02, 0}};
    skin.triangles = {{0, 1, 2}};
    EXPECT_THAT(error_of(skin, mesh, 0),
                HasSubstr("1 of 3 vertices lie too far outside of the thin tetrahedra "
                          "nearest to them (vertices 1): their weights pass 16"));
}

TEST(Embedding, Of_a_skin_that_cannot_move_is_refused) {
    const Tower tower;
    Skin skin;
    skin.vertices_m = {{0.05, 0.04, 0.02}, {0.05, 0.04, 0.01}, {0.04, 0.04, 0.01}};
    skin.triangles = {{0, 1, 2}};
    EXPECT_THAT(error_of(skin, tower.carrier, 0), HasSubstr("cannot move"));
}

constexpr const char* kTriangleStl = R"(solid one
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 20 0 0
vertex 0 10 5
endloop
endfacet
endsolid one
)";

std::string skin_error(const std::string& content, const std::string& extension) {
    try {
        (void)read_skin(content, extension, 1);
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        return error.what();
    }
    return "no error";
}

TEST(Skin, Is_read_from_STL_and_PLY_into_metres) {
    const Skin stl = read_skin(kTriangleStl, ".STL", 1e-3);
    EXPECT_EQ(stl.vertices_m, (std::vector<Point>{{0, 0, 0}, {20 * 1e-3, 0, 0}, {0, 10 * 1e-3, 5 * 1e-3}}));
    EXPECT_EQ(stl.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
    const Skin ply = read_skin(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
        ".ply", 1e-2);
    EXPECT_EQ(ply.vertices_m.size(), 4U);
    EXPECT_EQ(ply.triangles.size(), 2U);
    EXPECT_EQ(ply.vertices_m[1], (Point{1e-2, 0, 0}));
}

TEST(Skin, Of_anything_else_is_refused) {
    EXPECT_THAT(skin_error("MeshVersionFormatted 1\nDimension 3\n", ".mesh"), HasSubstr("STL or PLY"));
    EXPECT_THAT(skin_error(kTriangleStl, ".ply"), HasSubstr(".ply"));
    EXPECT_THAT(skin_error("solid nothing\nendsolid nothing\n", ".stl"), HasSubstr("no triangle"));
    EXPECT_NE(skin_error("Dear grandmother,", ".stl"), "no error");
}

}  // namespace
}  // namespace knead::tools
