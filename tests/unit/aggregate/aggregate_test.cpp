// SPDX-License-Identifier: Apache-2.0
#include "aggregate/aggregate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/error.h"
#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using testing::Each;
using testing::ElementsAre;
using namespace tools;

/// A clustering written down by hand: one cluster per bin, with its volume and barycentre worked out here.
ClusteredObject clustered(TetMesh mesh, const std::vector<std::uint32_t>& bin_of) {
    ClusteredObject object;
    const std::size_t count = mesh.tetrahedra.size();
    const std::uint32_t bins = 1 + *std::max_element(bin_of.begin(), bin_of.end());
    object.material = {
        std::vector<double>(count, 1), std::vector<double>(count, .3), std::vector<double>(count, 1), {}};
    Clustering& clustering = object.clustering;
    clustering.bin_of_tetrahedron = clustering.cluster_of_tetrahedron = bin_of;
    clustering.cluster_volume_m3.assign(bins, 0);
    clustering.cluster_barycentre_m.assign(bins, Point{});
    for (std::uint32_t bin = 0; bin < bins; ++bin) {
        clustering.bin_of_cluster.push_back(bin);
        clustering.bin_youngs_modulus_pa.push_back(1000.0 * (bin + 1));
        clustering.bin_poissons_ratio.push_back(0.1 * (bin + 1));
        clustering.bin_density_kg_per_m3.push_back(100.0 * (bin + 1));
    }
    for (std::size_t t = 0; t < count; ++t) {
        const double volume = signed_volume_m3(mesh, t);
        clustering.cluster_volume_m3[bin_of[t]] += volume;
        const Point centre = barycentre_m(mesh, t);
        for (int axis = 0; axis < 3; ++axis)
            clustering.cluster_barycentre_m[bin_of[t]][axis] += volume * centre[axis];
    }
    for (std::uint32_t bin = 0; bin < bins; ++bin)
        for (double& coordinate : clustering.cluster_barycentre_m[bin])
            coordinate /= clustering.cluster_volume_m3[bin];
    object.mesh = std::move(mesh);
    return object;
}

/// A strip of tetrahedra, each the neighbour of the next: nodes on a helix.
TetMesh strip(std::size_t count) {
    TetMesh mesh;
    for (std::size_t i = 0; i < count + 3; ++i) {
        const double angle = 2.0 * static_cast<double>(i);
        mesh.nodes_m.push_back({0.3 * std::cos(angle), 0.3 * std::sin(angle), static_cast<double>(i)});
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        Tetrahedron t{i, i + 1, i + 2, i + 3};
        mesh.tetrahedra.push_back(t);
        if (signed_volume_m3(mesh, i) < 0) std::swap(mesh.tetrahedra[i][2], mesh.tetrahedra[i][3]);
    }
    return mesh;
}

TEST(Aggregate, A_scattered_stiff_bin_gathers_around_its_barycentre) {
    // Stiff at both ends and in the middle of a strip: three equal volumes gather in the middle.
    const ClusteredObject object = clustered(strip(7), {1, 0, 0, 1, 0, 0, 1});
    const AggregateResult result = aggregate(object, {.interest = InterestKind::distance});
    EXPECT_THAT(result.material.bin_of_tetrahedron, ElementsAre(0, 0, 1, 1, 1, 0, 0));
    EXPECT_THAT(result.material.youngs_modulus_pa, ElementsAre(1000, 1000, 2000, 2000, 2000, 1000, 1000));
    EXPECT_EQ(result.material.poissons_ratio[3], 0.2);
    EXPECT_EQ(result.material.density_kg_per_m3[0], 100);
    EXPECT_EQ(result.jumps, 0U);
}

TEST(Aggregate, Soft_first_gathers_the_soft_bin_instead) {
    const ClusteredObject object = clustered(strip(7), {0, 1, 1, 0, 1, 1, 0});
    const AggregateResult result =
        aggregate(object, {.order = BinOrder::soft_first, .interest = InterestKind::distance});
    EXPECT_THAT(result.material.bin_of_tetrahedron, ElementsAre(1, 1, 0, 0, 0, 1, 1));
}

TEST(Aggregate, Modified_tetrahedra_are_crossed_and_not_counted) {
    // Bins 2 and 1 have the same barycentre, the middle. The stiffest takes it; the next one starts there
    // too, crosses it, and takes one tetrahedron on either side.
    const ClusteredObject object = clustered(strip(9), {0, 0, 0, 1, 2, 1, 0, 0, 0});
    ClusteredObject scattered = clustered(strip(9), {1, 0, 0, 0, 2, 0, 0, 0, 1});
    const AggregateResult result = aggregate(scattered, {.interest = InterestKind::distance});
    EXPECT_EQ(result.material.bin_of_tetrahedron, object.clustering.bin_of_tetrahedron);
}

TEST(Aggregate, Equal_volumes_give_exactly_as_many_tetrahedra_back) {
    const TetMesh mesh = kuhn_cube(6);
    std::vector<std::uint32_t> bin_of(mesh.tetrahedra.size());
    for (std::size_t t = 0; t < bin_of.size(); ++t)
        bin_of[t] = t % 3 == 0 ? 1 : 0;
    for (int kind = 0; kind < 5; ++kind) {
        const AggregateResult result =
            aggregate(clustered(mesh, bin_of), {.interest = static_cast<InterestKind>(kind)});
        const auto& after = result.material.bin_of_tetrahedron;
        EXPECT_EQ(std::count(after.begin(), after.end(), 1U), 432) << kind;
        EXPECT_NEAR(result.bins[1].after_m3, result.bins[1].before_m3, 1e-15);
    }
}

TEST(Aggregate, One_bin_covers_everything) {
    const AggregateResult result = aggregate(clustered(kuhn_cube(2), std::vector<std::uint32_t>(48, 0)), {});
    EXPECT_THAT(result.material.bin_of_tetrahedron, Each(0U));
    EXPECT_THAT(result.material.youngs_modulus_pa, Each(1000));
}

TEST(Aggregate, A_disconnected_part_is_reached_from_the_nearest_unmodified_tetrahedron) {
    // Two strips far apart. All of the stiff volume but one tetrahedron lies in the first one, which is full
    // after its four: the rest jumps to the tetrahedron of the other strip that is nearest.
    TetMesh mesh = strip(4);
    const TetMesh second = strip(4);
    for (Point node : second.nodes_m)
        mesh.nodes_m.push_back({node[0] + 10, node[1], node[2]});
    for (Tetrahedron t : second.tetrahedra) {
        for (std::uint32_t& node : t)
            node += 7;
        mesh.tetrahedra.push_back(t);
    }
    const ClusteredObject object = clustered(mesh, {1, 1, 1, 1, 1, 0, 0, 0});
    const AggregateResult result = aggregate(object, {.interest = InterestKind::distance});
    EXPECT_EQ(result.jumps, 1U);
    const auto& after = result.material.bin_of_tetrahedron;
    EXPECT_THAT(std::vector(after.begin(), after.begin() + 4), Each(1U));
    EXPECT_EQ(std::count(after.begin() + 4, after.end(), 1U), 1);
    const Point centre = object.clustering.cluster_barycentre_m[1];
    std::size_t nearest = 4;
    const auto height_from_centre = [&](std::size_t t) {
        return std::abs(barycentre_m(mesh, t)[2] - centre[2]);
    };
    for (std::size_t t = 5; t < 8; ++t)
        if (height_from_centre(t) < height_from_centre(nearest)) nearest = t;
    EXPECT_EQ(after[nearest], 1U);
}

TEST(Aggregate, A_barycentre_outside_the_object_starts_at_the_nearest_tetrahedron) {
    // Stiff at both ends of a U: its barycentre lies in the gap between the legs.
    const TetMesh mesh = kuhn_box(3, 1, 3, {3, 1, 3});
    TetMesh u;
    std::vector<std::uint32_t> bin_of;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        const Point centre = barycentre_m(mesh, t);
        if (centre[0] > 1 && centre[0] < 2 && centre[2] > 1) continue;  // the gap
        u.tetrahedra.push_back(mesh.tetrahedra[t]);
        bin_of.push_back(centre[2] > 2 ? 1 : 0);
    }
    u.nodes_m = mesh.nodes_m;
    const ClusteredObject object = clustered(u, bin_of);
    EXPECT_NEAR(object.clustering.cluster_barycentre_m[1][0], 1.5, 1e-9);  // in the gap
    const AggregateResult result = aggregate(object, {.interest = InterestKind::distance});
    EXPECT_NEAR(result.bins[1].after_m3, 2.0, 1e-9);
    std::size_t nearest = 0;
    std::size_t farthest = 0;
    const auto distance = [&](std::size_t t) {
        const Point centre = barycentre_m(u, t);
        return std::hypot(centre[0] - 1.5, centre[1] - 0.5, centre[2] - 2.5);
    };
    for (std::size_t t = 0; t < u.tetrahedra.size(); ++t) {
        if (distance(t) < distance(nearest) - 1e-9) nearest = t;
        if (distance(t) > distance(farthest) + 1e-9) farthest = t;
    }
    EXPECT_EQ(result.material.bin_of_tetrahedron[nearest], 1U);
    EXPECT_EQ(result.material.bin_of_tetrahedron[farthest], 0U);
    EXPECT_EQ(result.material.bin_of_tetrahedron[0], 0U);
}

TEST(Aggregate, Bad_weights_are_bad_usage) {
    const ClusteredObject object = clustered(kuhn_cube(1), {0, 0, 0, 1, 1, 1});
    for (const double weight :
         {-0.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        EXPECT_THROW((void)aggregate(object, {.direction_weight = weight}), ToolError);
}

}  // namespace
}  // namespace knead::test
