// SPDX-License-Identifier: Apache-2.0
#include "cluster/kmeans.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "cluster/point_tree.h"

namespace knead::test {
namespace {

using namespace tools;

std::vector<Point> random_points(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::vector<Point> points(count);
    for (Point& point : points)
        for (double& coordinate : point)
            coordinate = 5 + static_cast<double>(engine() >> 11U) * 0x1.0p-53;
    return points;
}

double inertia_of(const std::vector<Point>& points, const std::vector<std::uint32_t>& labels) {
    const std::uint32_t clusters = 1 + *std::max_element(labels.begin(), labels.end());
    double inertia = 0;
    for (std::uint32_t cluster = 0; cluster < clusters; ++cluster) {
        Point mean{};
        int count = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (labels[i] == cluster) {
                ++count;
                for (int axis = 0; axis < 3; ++axis)
                    mean[axis] += points[i][axis];
            }
        if (count == 0) continue;
        for (double& coordinate : mean)
            coordinate /= count;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (labels[i] == cluster)
                for (int axis = 0; axis < 3; ++axis)
                    inertia += (points[i][axis] - mean[axis]) * (points[i][axis] - mean[axis]);
    }
    return inertia;
}

double best_inertia(const std::vector<Point>& points, std::uint32_t clusters) {
    std::vector<std::uint32_t> labels(points.size(), 0);
    double best = std::numeric_limits<double>::infinity();
    while (true) {
        best = std::min(best, inertia_of(points, labels));
        std::size_t digit = 0;
        while (digit < labels.size() && ++labels[digit] == clusters)
            labels[digit++] = 0;
        if (digit == labels.size()) return best;
    }
}

/// Sums of a few hundred squares in different orders.
constexpr double kRounding = 1e-12;

TEST(Kmeans, With_many_restarts_reaches_the_optimum_of_all_assignments) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const auto points = random_points(9, seed);
        for (const std::uint32_t clusters : {1U, 2U, 3U}) {
            const KmeansResult result = kmeans(points, {.clusters = clusters, .restarts = 50, .seed = seed});
            const double best = best_inertia(points, clusters);
            EXPECT_NEAR(result.inertia_m2, best, kRounding * points.size()) << seed << " " << clusters;
            EXPECT_TRUE(result.converged);
        }
    }
}

TEST(Kmeans, Separated_groups_are_found) {
    std::vector<Point> points;
    for (int group = 0; group < 4; ++group)
        for (const Point& point : random_points(100, 40 + static_cast<std::uint64_t>(group)))
            points.push_back({point[0] + 10 * group, point[1], point[2]});
    const KmeansResult result = kmeans(points, {.clusters = 4});
    for (std::size_t group = 0; group < 4; ++group)
        for (std::size_t i = 0; i < 100; ++i)
            EXPECT_EQ(result.cluster_of_point[100 * group + i], result.cluster_of_point[100 * group]);
    EXPECT_EQ(std::set(result.cluster_of_point.begin(), result.cluster_of_point.end()).size(), 4U);
}

TEST(Kmeans, Every_point_is_with_its_closest_centre_and_every_centre_is_the_mean_of_its_points) {
    const auto points = random_points(3000, 2);
    const KmeansResult result = kmeans(points, {.clusters = 7});
    std::vector<Point> sum(7, Point{});
    std::vector<double> count(7, 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& own = result.centres_m[result.cluster_of_point[i]];
        for (const Point& other : result.centres_m)
            EXPECT_LE(squared_distance(points[i], own), squared_distance(points[i], other) + kRounding);
        for (int axis = 0; axis < 3; ++axis)
            sum[result.cluster_of_point[i]][axis] += points[i][axis];
        ++count[result.cluster_of_point[i]];
    }
    for (std::size_t c = 0; c < 7; ++c)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(result.centres_m[c][axis], sum[c][axis] / count[c], 1e-9);
}

TEST(Kmeans, As_many_clusters_as_points_leaves_no_inertia) {
    const auto points = random_points(5, 1);
    for (const std::uint32_t clusters : {5U, 6U, 1000U}) {
        const KmeansResult result = kmeans(points, {.clusters = clusters});
        EXPECT_EQ(result.centres_m.size(), 5U);
        EXPECT_EQ(std::set(result.cluster_of_point.begin(), result.cluster_of_point.end()).size(), 5U);
        EXPECT_NEAR(result.inertia_m2, 0, kRounding);
    }
}

TEST(Kmeans, Points_that_coincide_share_a_cluster) {
    const std::vector<Point> points{{1, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}};
    const KmeansResult result = kmeans(points, {.clusters = 3});
    EXPECT_EQ(result.centres_m.size(), 2U);
    EXPECT_EQ(result.cluster_of_point[0], result.cluster_of_point[1]);
    EXPECT_EQ(result.cluster_of_point[0], result.cluster_of_point[3]);
    EXPECT_NE(result.cluster_of_point[0], result.cluster_of_point[2]);
}

TEST(Kmeans, Same_seed_gives_the_same_with_any_number_of_threads) {
    const auto points = random_points(20000, 8);
    const KmeansResult reference = kmeans(points, {.clusters = 5, .seed = 3});
    for (const std::size_t threads : {1U, 2U, 4U}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        const KmeansResult result = kmeans(points, {.clusters = 5, .seed = 3});
        EXPECT_EQ(result.cluster_of_point, reference.cluster_of_point);
        EXPECT_EQ(result.centres_m, reference.centres_m);
        EXPECT_EQ(result.inertia_history_m2, reference.inertia_history_m2);
    }
}

TEST(Kmeans, Stops_at_the_given_number_of_iterations_and_says_so) {
    const KmeansResult result =
        kmeans(random_points(5000, 4), {.clusters = 6, .restarts = 1, .max_iterations = 2});
    EXPECT_EQ(result.inertia_history_m2.size(), 2U);
    EXPECT_FALSE(result.converged);
}

TEST(Closest_centre, Ties_go_to_the_lower_index) {
    const std::vector<Point> centres{{2, 0, 0}, {-1, 0, 0}, {1, 0, 0}};
    EXPECT_EQ(closest_centre({0, 0, 0}, centres), 1U);
}

TEST(Point_tree, Assigns_like_a_plain_loop_over_points_and_centres) {
    const auto points = random_points(4000, 6);
    const PointTree tree(points);
    for (const std::size_t count : {1U, 2U, 9U, 60U}) {
        auto centres = random_points(count, 100 + count);
        for (Point& centre : centres)
            for (int axis = 0; axis < 3; ++axis)
                centre[axis] -= tree.origin_m()[axis];
        std::vector<std::uint64_t> counts(count, 0);
        double inertia = 0;
        for (Point point : points) {
            for (int axis = 0; axis < 3; ++axis)
                point[axis] -= tree.origin_m()[axis];
            std::size_t best = 0;
            for (std::size_t c = 1; c < count; ++c)
                if (squared_distance(point, centres[c]) < squared_distance(point, centres[best])) best = c;
            ++counts[best];
            inertia += squared_distance(point, centres[best]);
        }
        const AssignmentSums sums = tree.assign(centres);
        EXPECT_EQ(sums.count, counts);
        EXPECT_NEAR(sums.inertia_m2, inertia, kRounding * inertia * 100);
    }
}

}  // namespace
}  // namespace knead::test
