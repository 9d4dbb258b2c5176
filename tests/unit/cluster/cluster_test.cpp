// SPDX-License-Identifier: Apache-2.0
#include "cluster/cluster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/error.h"
#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using testing::ElementsAre;
using namespace tools;

constexpr double kRounding = 1e-12;  // of sums of a few hundred positive terms

/// Soft below 0.06 m, stiff above, in a jittered cube of four cells each way.
struct Layered {
    TetMesh mesh = kuhn_cube(4);
    Material material;
    Layered() {
        jitter(mesh, 0.025, 0.1, 1);
        for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
            const bool stiff = barycentre_m(mesh, t)[2] > 0.06;
            material.youngs_modulus_pa.push_back((stiff ? 40e3 : 4e3) + static_cast<double>(t));
            material.poissons_ratio.push_back(stiff ? 0.3 : 0.45);
            material.density_kg_per_m3.push_back(stiff ? 1200 : 1000);
        }
    }
};

TEST(Cluster, Homogenised_modulus_of_two_tetrahedra_is_weighted_by_their_volumes) {
    TetMesh mesh;  // volumes 1/6 and 1/2
    mesh.nodes_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -3}};
    mesh.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
    const Material material{{1000, 3000}, {0.2, 0.4}, {900, 1300}, {}};
    const ClusterResult result = cluster_object(mesh, material, {.bins = 1, .clusters = 1});
    const Clustering& clustering = result.clustering;
    EXPECT_NEAR(clustering.bin_youngs_modulus_pa[0], 2500, 2500 * kRounding);
    EXPECT_NEAR(clustering.bin_poissons_ratio[0], 0.35, kRounding);
    EXPECT_NEAR(clustering.bin_density_kg_per_m3[0], 1200, 1200 * kRounding);
    EXPECT_NEAR(clustering.cluster_volume_m3[0], 2.0 / 3, kRounding);
    // Barycentres at z = 1/4 and -3/4, weighted 1 to 3.
    EXPECT_NEAR(clustering.cluster_barycentre_m[0][2], -0.5, kRounding);
    EXPECT_NEAR(clustering.cluster_barycentre_m[0][0], 0.25, kRounding);
}

TEST(Cluster, Bins_and_clusters_agree_with_each_other_and_with_the_volumes) {
    const Layered object;
    const Clustering clustering =
        cluster_object(object.mesh, object.material, {.bins = 2, .clusters = 3}).clustering;
    ASSERT_THAT(clustering.bin_of_cluster, ElementsAre(0, 0, 0, 1, 1, 1));
    std::vector<double> volume(6, 0);
    for (std::size_t t = 0; t < object.mesh.tetrahedra.size(); ++t) {
        const bool stiff = object.material.youngs_modulus_pa[t] > 2e4;
        EXPECT_EQ(clustering.bin_of_tetrahedron[t], stiff ? 1U : 0U);
        EXPECT_EQ(clustering.bin_of_cluster[clustering.cluster_of_tetrahedron[t]], stiff ? 1U : 0U);
        volume[clustering.cluster_of_tetrahedron[t]] += signed_volume_m3(object.mesh, t);
    }
    for (int cluster = 0; cluster < 6; ++cluster)
        EXPECT_NEAR(clustering.cluster_volume_m3[cluster], volume[cluster], volume[cluster] * kRounding);
    EXPECT_EQ(clustering.bin_poissons_ratio[0], 0.45);  // the mean of equal values is that value
    EXPECT_EQ(clustering.bin_poissons_ratio[1], 0.3);
}

TEST(Cluster, Clusters_are_capped_by_the_tetrahedra_of_the_bin) {
    TetMesh mesh = kuhn_cube(1);
    const Material material{
        {1e3, 1e3, 1e3, 1e3, 9e3, 9e3}, std::vector<double>(6, .3), std::vector<double>(6, 1), {}};
    jitter(mesh, 0.1, 0.05, 1);
    EXPECT_THAT(cluster_object(mesh, material, {.bins = 2, .clusters = 4}).clustering.bin_of_cluster,
                ElementsAre(0, 0, 0, 0, 1, 1));
}

TEST(Cluster, One_value_and_several_bins_gives_one_bin_with_exactly_that_value) {
    const TetMesh mesh = kuhn_cube(3);
    const Material material{
        std::vector<double>(162, 22222.2), std::vector<double>(162, .3), std::vector<double>(162, 1000), {}};
    const Clustering clustering = cluster_object(mesh, material, {.bins = 4}).clustering;
    EXPECT_THAT(clustering.bin_youngs_modulus_pa, ElementsAre(22222.2));
}

TEST(Cluster, Nothing_of_bins_clusters_or_restarts_is_bad_usage) {
    const Layered object;
    const auto code_of = [&](const ClusterOptions& options) {
        try {
            (void)cluster_object(object.mesh, object.material, options);
        } catch (const ToolError& error) {
            return error.code();
        }
        return ExitCode::done;
    };
    EXPECT_EQ(code_of({.bins = 0}), ExitCode::bad_usage);
    EXPECT_EQ(code_of({.clusters = 0}), ExitCode::bad_usage);
    EXPECT_EQ(code_of({.restarts = 0}), ExitCode::bad_usage);
}

}  // namespace
}  // namespace knead::test
