// SPDX-License-Identifier: Apache-2.0
#include "aggregate/tetrahedron_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using tools::TetrahedronTree;

double distance(const Point& a, const Point& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Volume of the tetrahedron against the sum of the four that a point makes with its faces: equal when
/// inside.
bool is_inside(const TetMesh& mesh, std::uint32_t t, const Point& point) {
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        std::array<Point, 4> part{};
        for (int j = 0; j < 4; ++j)
            part[j] = i == j ? point : mesh.nodes_m[mesh.tetrahedra[t][j]];
        sum += std::abs(signed_volume_m3(part[0], part[1], part[2], part[3]));
    }
    return sum <= signed_volume_m3(mesh, t) * (1 + 1e-9);
}

struct Jittered {
    TetMesh mesh = kuhn_cube(5);
    Jittered() { jitter(mesh, 0.02, 0.12, 4); }
};

std::vector<Point> random_points(std::size_t count, double low, double high) {
    std::mt19937_64 engine(12);
    std::vector<Point> points(count);
    for (Point& point : points)
        for (double& coordinate : point)
            coordinate = low + (high - low) * static_cast<double>(engine() >> 11U) * 0x1.0p-53;
    return points;
}

TEST(Tetrahedron_tree, Containing_agrees_with_a_look_at_every_tetrahedron) {
    const Jittered object;
    const TetrahedronTree tree(object.mesh);
    int inside = 0;
    for (const Point& point : random_points(500, -0.01, 0.11)) {
        std::optional<std::uint32_t> expected;
        for (std::uint32_t t = 0; t < object.mesh.tetrahedra.size() && !expected; ++t)
            if (is_inside(object.mesh, t, point)) expected = t;
        EXPECT_EQ(tree.containing(point), expected);
        inside += expected ? 1 : 0;
    }
    EXPECT_GT(inside, 100);
    EXPECT_LT(inside, 500);
}

TEST(Tetrahedron_tree, A_point_on_a_shared_node_belongs_to_the_lowest_tetrahedron_there) {
    const TetMesh mesh = kuhn_cube(4);
    const TetrahedronTree tree(mesh);
    for (std::uint32_t node = 0; node < mesh.nodes_m.size(); ++node) {
        std::uint32_t lowest = UINT32_MAX;
        for (std::uint32_t t = 0; t < mesh.tetrahedra.size() && lowest == UINT32_MAX; ++t)
            for (const std::uint32_t corner : mesh.tetrahedra[t])
                if (corner == node) lowest = t;
        EXPECT_EQ(tree.containing(mesh.nodes_m[node]), lowest);
    }
}

TEST(Tetrahedron_tree, Nearest_present_agrees_with_a_look_at_every_barycentre_while_they_are_removed) {
    const Jittered object;
    TetrahedronTree tree(object.mesh);
    std::vector<bool> removed(object.mesh.tetrahedra.size(), false);
    std::mt19937_64 engine(5);
    for (const Point& point : random_points(object.mesh.tetrahedra.size(), -0.05, 0.15)) {
        std::uint32_t expected = UINT32_MAX;
        double shortest = std::numeric_limits<double>::infinity();
        for (std::uint32_t t = 0; t < removed.size(); ++t) {
            const double candidate = distance(barycentre_m(object.mesh, t), point);
            if (!removed[t] && candidate < shortest) {
                shortest = candidate;
                expected = t;
            }
        }
        ASSERT_EQ(tree.nearest_present(point), expected);
        removed[expected] = true;
        tree.remove(expected);
    }
    EXPECT_EQ(tree.nearest_present({0, 0, 0}), std::nullopt);
}

TEST(Tetrahedron_tree, Nearest_and_containing_still_count_what_was_removed) {
    const Jittered object;
    TetrahedronTree tree(object.mesh);
    const Point point = barycentre_m(object.mesh, 17);
    tree.remove(17);
    EXPECT_EQ(tree.nearest(point), 17U);
    EXPECT_EQ(tree.containing(point), 17U);
    EXPECT_NE(tree.nearest_present(point), 17U);
}

}  // namespace
}  // namespace knead::test
