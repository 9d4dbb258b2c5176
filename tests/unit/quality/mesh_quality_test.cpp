// SPDX-License-Identifier: Apache-2.0
#include "quality/mesh_quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "support/kuhn_cube.h"

namespace knead::tools {
namespace {

using testing::ElementsAre;

constexpr double kRounding = 1e-12;  // of numbers around 1, added up over 162 tetrahedra

/// Two corner tetrahedra apart from each other, the second one pressed flat to `height`.
TetMesh two_corners(double height) {
    TetMesh mesh;
    mesh.nodes_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                    {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, height}};
    mesh.tetrahedra = {{0, 1, 2, 3}, {4, 5, 6, 7}};
    return mesh;
}

TEST(MeshQuality, Of_the_kuhn_cube_has_all_tetrahedra_alike) {
    const MeshQuality quality = measure(test::kuhn_cube(3, 3));
    // Edges 1, 1, 1, sqrt 2, sqrt 2, sqrt 3; volume 1/6; faces of areas 1/2, 1/2, 1/sqrt 2, 1/sqrt 2.
    const double inscribed = 3.0 / 6 / (1 + std::sqrt(2.0));
    const double expected = 3 * inscribed / (std::sqrt(3.0) / 2);
    EXPECT_NEAR(quality.min_radius_ratio, expected, kRounding);
    EXPECT_NEAR(quality.mean_radius_ratio, expected, kRounding);
    EXPECT_NEAR(quality.min_mean_ratio, 12 * std::pow(0.5, 2.0 / 3) / 10, kRounding);
    EXPECT_NEAR(quality.min_dihedral_deg, 45, 1e-10);  // rounding of an angle in degrees
    EXPECT_NEAR(quality.max_dihedral_deg, 90, 1e-10);
    EXPECT_EQ(quality.radius_ratio_histogram[7], 162u);
    EXPECT_NEAR(quality.volume_m3, 27, kRounding * 27);
    EXPECT_NEAR(quality.longest_edge_m, std::sqrt(3.0), kRounding);
    EXPECT_NEAR(quality.extent_m(), 3, kRounding);
    EXPECT_EQ(quality.bodies, 1u);
    EXPECT_EQ(quality.worst.size(), kWorstNamed);
}

TEST(MeshQuality, Counts_every_tetrahedron_once_in_each_histogram) {
    TetMesh mesh = test::kuhn_cube(4);
    test::jitter(mesh, 0.025, 0.14, 3);
    const MeshQuality quality = measure(mesh);
    const auto count = [](const auto& histogram) {
        return std::accumulate(histogram.begin(), histogram.end(), std::uint64_t{0});
    };
    EXPECT_EQ(count(quality.radius_ratio_histogram), mesh.tetrahedra.size());
    EXPECT_EQ(count(quality.min_dihedral_histogram), mesh.tetrahedra.size());
    for (std::size_t k = 1; k < quality.worst.size(); ++k)
        EXPECT_LE(quality.worst[k - 1].shape.radius_ratio, quality.worst[k].shape.radius_ratio);
    EXPECT_EQ(quality.worst.front().shape.radius_ratio, quality.min_radius_ratio);
}

TEST(MeshQuality, Names_the_flat_one_of_two_bodies) {
    const MeshQuality quality = measure(two_corners(0.01));
    EXPECT_EQ(quality.bodies, 2u);
    EXPECT_THAT(quality.slivers, ElementsAre(1u));
    EXPECT_THAT(quality.near_inverted, ElementsAre(1u));
    ASSERT_EQ(quality.worst.size(), 2u);
    EXPECT_EQ(quality.worst[0].tetrahedron, 1u);
    EXPECT_NEAR(quality.worst[0].middle_m[0], 5.25, kRounding);
    EXPECT_THAT(measure(two_corners(1)).slivers, ElementsAre());
}

}  // namespace
}  // namespace knead::tools
