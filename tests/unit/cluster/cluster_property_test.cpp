// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "cluster/cluster.h"
#include "cluster/kmeans.h"
#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using namespace tools;

/// The inertia of a cell is the difference of sums of squares, each rounded at 1e-16 of them.
constexpr double kRounding = 1e-12;

std::vector<Point> any_points() {
    const auto count = *rc::gen::inRange(1, 2000);
    std::mt19937_64 engine(*rc::gen::arbitrary<std::uint64_t>());
    std::vector<Point> points(static_cast<std::size_t>(count));
    for (Point& point : points)
        for (double& coordinate : point)
            coordinate = static_cast<double>(engine() >> 11U) * 0x1.0p-53;
    return points;
}

RC_GTEST_PROP(Kmeans_property, Inertia_never_rises, ()) {
    const auto points = any_points();
    const auto clusters = static_cast<std::uint32_t>(*rc::gen::inRange(1, 20));
    const KmeansResult result = kmeans(points, {.clusters = clusters, .restarts = 2});
    const auto& history = result.inertia_history_m2;
    const double slack = kRounding * static_cast<double>(points.size());
    for (std::size_t i = 1; i < history.size(); ++i)
        RC_ASSERT(history[i] <= history[i - 1] + slack);
    RC_ASSERT(result.inertia_m2 <= history.back() + slack);
}

RC_GTEST_PROP(Kmeans_property, Order_of_the_points_does_not_matter, ()) {
    const auto points = any_points();
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937_64(*rc::gen::arbitrary<std::uint64_t>()));
    std::vector<Point> shuffled;
    for (const std::size_t i : order)
        shuffled.push_back(points[i]);
    const KmeansOptions options{.clusters = static_cast<std::uint32_t>(*rc::gen::inRange(1, 8))};
    const KmeansResult a = kmeans(points, options);
    const KmeansResult b = kmeans(shuffled, options);
    RC_ASSERT(a.centres_m == b.centres_m);
    for (std::size_t i = 0; i < order.size(); ++i)
        RC_ASSERT(b.cluster_of_point[i] == a.cluster_of_point[order[i]]);
}

RC_GTEST_PROP(Kmeans_property, Every_cluster_is_used, ()) {
    const auto points = any_points();
    const KmeansResult result =
        kmeans(points, {.clusters = static_cast<std::uint32_t>(*rc::gen::inRange(1, 40))});
    std::vector<bool> used(result.centres_m.size(), false);
    for (const std::uint32_t cluster : result.cluster_of_point)
        used.at(cluster) = true;
    RC_ASSERT(std::all_of(used.begin(), used.end(), [](bool value) { return value; }));
}

RC_GTEST_PROP(Cluster_property, Clustering_is_valid_and_the_same_on_one_and_four_threads, ()) {
    TetMesh mesh = kuhn_cube(4);
    jitter(mesh, 0.025, 0.1, *rc::gen::arbitrary<std::uint64_t>());
    const std::size_t count = mesh.tetrahedra.size();
    Material material{{}, std::vector<double>(count, 0.3), std::vector<double>(count, 1000), {}};
    for (std::size_t t = 0; t < count; ++t)
        material.youngs_modulus_pa.push_back(1e3 + *rc::gen::inRange(0, 100000));
    const ClusterOptions options{.bins = static_cast<std::uint32_t>(*rc::gen::inRange(1, 7)),
                                 .clusters = static_cast<std::uint32_t>(*rc::gen::inRange(1, 10)),
                                 .binning = static_cast<Binning>(*rc::gen::inRange(0, 4))};
    const auto run = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return cluster_object(mesh, material, options).clustering;
    };
    const Clustering one = run(1);
    const Clustering four = run(4);
    const Status status = validate(one, count);
    RC_ASSERT(status.ok());
    RC_ASSERT(one.cluster_of_tetrahedron == four.cluster_of_tetrahedron);
    RC_ASSERT(one.cluster_barycentre_m == four.cluster_barycentre_m);
    RC_ASSERT(one.bin_youngs_modulus_pa == four.bin_youngs_modulus_pa);
}

}  // namespace
}  // namespace knead::test
