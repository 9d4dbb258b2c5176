// SPDX-License-Identifier: Apache-2.0
#include "knead/runtime/embedded_surface.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <random>

#include "knead/formats/write/write.h"
#include "knead/runtime/simulation.h"
#include "unit/runtime/block_asset.h"
#include "unit/runtime/watched_calls.h"

namespace knead::test {
namespace {

/// Weights, results: float32. Half a unit of the last place each of values up to 1 m.
constexpr double kFloat_m = 2e-7;

using Matrix = std::array<std::array<double, 3>, 3>;

double uniform(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11U) * 0x1.0p-53;
}

double determinant(const Point& a, const Point& b, const Point& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// Where a point is in a tetrahedron: volumes of the tetrahedra it makes with the faces.
std::array<double, 4> barycentric(const std::array<Point, 4>& corners, const Point& p) {
    const auto volume = [](const std::array<Point, 4>& c) {
        std::array<Point, 3> edge{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                edge[k][axis] = c[k + 1][axis] - c[0][axis];
        return determinant(edge[0], edge[1], edge[2]);
    };
    std::array<double, 4> weights{};
    for (std::size_t k = 0; k < 4; ++k) {
        std::array<Point, 4> with_point = corners;
        with_point[k] = p;
        weights[k] = volume(with_point) / volume(corners);
    }
    return weights;
}

/// A cube whose surface is a cloud: random points in it and a little outside, then two still ones.
struct Cloud {
    Asset asset = cube_asset(3, ToolShape::plate, ToolContact::bonded);
    std::vector<Point> vertices_m;  ///< at rest, where the points were drawn

    explicit Cloud(std::size_t moving = 50) {
        std::mt19937_64 random(3);
        SurfaceEmbedding& embedding = asset.embedding;
        for (std::size_t v = 0; v < moving; ++v) {
            const auto t = static_cast<std::uint32_t>(random() % asset.tetrahedra.size());
            std::array<Point, 4> corners{};
            Point p{};
            for (std::size_t k = 0; k < 4; ++k) {
                corners[k] = asset.nodes_m[asset.tetrahedra[t][k]];
                for (std::size_t axis = 0; axis < 3; ++axis)
                    p[axis] += corners[k][axis] / 4 + 0.01 * (uniform(random) - 0.5) / 2;
            }
            embedding.tetrahedron.push_back(t);
            const auto w = barycentric(corners, p);
            embedding.weights.push_back({static_cast<float>(w[0]), static_cast<float>(w[1]),
                                         static_cast<float>(w[2]), static_cast<float>(w[3])});
            vertices_m.push_back(p);
        }
        embedding.still_vertices_m = {{0.05, 0.05, -0.002}, {0.01, 0.02, -0.001}};
        vertices_m.insert(vertices_m.end(), embedding.still_vertices_m.begin(),
                          embedding.still_vertices_m.end());
        for (std::uint32_t v = 0; v + 2 < vertices_m.size(); ++v)
            embedding.triangles.push_back({v, v + 1, v + 2});
    }

    [[nodiscard]] std::size_t moving() const { return asset.embedding.tetrahedron.size(); }
};

Point mapped(const Matrix& linear, const Point& shift, const Point& p) {
    Point result = shift;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t k = 0; k < 3; ++k)
            result[row] += linear[row][k] * p[k];
    return result;
}

std::vector<float> updated(const EmbeddedSurface& surface, const std::vector<Point>& nodes_m) {
    std::vector<float> vertices_m(3 * surface.vertex_count(), -1);
    surface.update(nodes_m.front().data(), vertices_m.data());
    return vertices_m;
}

/// The nodes moved by x -> linear x + shift: the moving vertices go the same way, the still ones stay.
void expect_carried_along(const Matrix& linear, const Point& shift) {
    const Cloud cloud;
    std::vector<Point> nodes_m = cloud.asset.nodes_m;
    for (Point& p : nodes_m)
        p = mapped(linear, shift, p);
    const auto surface = EmbeddedSurface::create(cloud.asset);
    ASSERT_TRUE(surface.ok());
    const std::vector<float> vertices_m = updated(surface.value(), nodes_m);
    for (std::size_t v = 0; v < cloud.vertices_m.size(); ++v) {
        const bool moves = v < cloud.moving();
        const Point expected = moves ? mapped(linear, shift, cloud.vertices_m[v]) : cloud.vertices_m[v];
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(vertices_m[3 * v + axis], expected[axis], kFloat_m) << "vertex " << v;
    }
}

TEST(Embedded_surface, is_where_its_points_were_at_rest) {
    expect_carried_along({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {0, 0, 0});
}

TEST(Embedded_surface, moves_rigidly_with_a_rigid_motion) {
    expect_carried_along({{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}}, {0.4, -0.3, 0.5});
}

TEST(Embedded_surface, is_stretched_and_sheared_with_the_object) {
    expect_carried_along({{{1.3, 0.2, 0}, {0, 0.8, 0.1}, {0, 0.05, 0.5}}}, {0, 0, 0.01});
}

TEST(Embedded_surface, after_a_press_is_the_weighted_sum_of_its_nodes) {
    const Cloud cloud;
    const auto surface = EmbeddedSurface::create(cloud.asset);
    auto simulation = Simulation::create(cloud.asset);
    ASSERT_TRUE(surface.ok() && simulation.ok());
    Pose pose = simulation.value().tool_rest_pose();
    for (int i = 0; i < 50; ++i) {
        pose.position_m[2] -= 0.0003;
        (void)simulation.value().step(pose, 1e-3);
    }
    const double* x = simulation.value().positions_m();
    std::vector<float> vertices_m(3 * surface.value().vertex_count());
    surface.value().update(x, vertices_m.data());
    const SurfaceEmbedding& embedding = cloud.asset.embedding;
    double farthest_m = 0;
    for (std::size_t v = 0; v < cloud.moving(); ++v) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double expected = 0;
            for (std::size_t k = 0; k < 4; ++k)
                expected += static_cast<double>(embedding.weights[v][k]) *
                            x[3 * cloud.asset.tetrahedra[embedding.tetrahedron[v]][k] + axis];
            EXPECT_NEAR(vertices_m[3 * v + axis], expected, kFloat_m) << "vertex " << v;
            farthest_m = std::max(farthest_m, std::abs(expected - cloud.vertices_m[v][axis]));
        }
    }
    EXPECT_GT(farthest_m, 0.005) << "nothing has moved";
}

TEST(Embedded_surface, says_its_sizes_and_triangles) {
    const Cloud cloud;
    const auto surface = EmbeddedSurface::create(cloud.asset);
    ASSERT_TRUE(surface.ok());
    EXPECT_EQ(surface.value().vertex_count(), 52u);
    EXPECT_EQ(surface.value().triangles(), cloud.asset.embedding.triangles);
}

TEST(Embedded_surface, of_still_vertices_only_stays) {
    const Cloud cloud(0);
    ASSERT_EQ(cloud.moving(), 0u);
    Asset asset = cloud.asset;
    asset.embedding.still_vertices_m.push_back({0, 0, -0.5});
    asset.embedding.triangles = {{0, 1, 2}};
    const auto surface = EmbeddedSurface::create(asset);
    ASSERT_TRUE(surface.ok()) << surface.error().text();
    EXPECT_EQ(updated(surface.value(), asset.nodes_m)[8], -0.5F);
}

TEST(Embedded_surface, update_neither_allocates_nor_locks) {
    const Cloud cloud;
    const auto surface = EmbeddedSurface::create(cloud.asset);
    ASSERT_TRUE(surface.ok());
    std::vector<float> vertices_m(3 * surface.value().vertex_count());
    const WatchedCalls before = watched_calls();
    surface.value().update(cloud.asset.nodes_m.front().data(), vertices_m.data());
    const WatchedCalls during = watched_calls() - before;
    EXPECT_EQ(during.allocations + during.frees + during.locks, 0);
    EXPECT_GT(before.allocations, 0);
}

TEST(Embedded_surface, of_an_asset_without_one_is_refused) {
    const auto surface = EmbeddedSurface::create(cube_asset(2, ToolShape::plate, ToolContact::bonded));
    ASSERT_FALSE(surface.ok());
    EXPECT_EQ(surface.error().code, ErrorCode::invalid_argument);
}

TEST(Embedded_surface, of_an_asset_that_is_not_valid_is_refused) {
    Cloud cloud;
    cloud.asset.embedding.tetrahedron[7] = 100000;
    const auto surface = EmbeddedSurface::create(cloud.asset);
    ASSERT_FALSE(surface.ok());
    EXPECT_EQ(surface.error().code, ErrorCode::invalid_data);
}

TEST(Embedded_surface, from_a_file_is_that_of_the_asset) {
    const auto file =
        std::filesystem::path(testing::TempDir()) / ("knead-embedded-" + std::to_string(::getpid()) + ".hdf");
    const Cloud cloud;
    ASSERT_TRUE(write_asset(file, cloud.asset, {"knead-test", "0.1.0", {}, 0, {}}).ok());
    const auto surface = EmbeddedSurface::load(file);
    const auto made = EmbeddedSurface::create(cloud.asset);
    std::filesystem::remove(file);
    ASSERT_TRUE(surface.ok() && made.ok());
    EXPECT_EQ(updated(surface.value(), cloud.asset.nodes_m), updated(made.value(), cloud.asset.nodes_m));

    const auto none = EmbeddedSurface::load(file);
    ASSERT_FALSE(none.ok());
    EXPECT_EQ(none.error().code, ErrorCode::io_error);
}

}  // namespace
}  // namespace knead::test
