// SPDX-License-Identifier: GPL-3.0-or-later
#include "cluster/kmeans.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "cluster/point_tree.h"

namespace knead::tools {
namespace {

/// Centres that move by less than this share of the points' diagonal stand still. One point that changes
/// sides among 10^8 still moves a centre more; rounding moves it far less.
constexpr double kStandstill = 1e-11;

/// Far-apart seeds for neighbouring restarts (the finaliser of splitmix64).
std::uint64_t seed_of_restart(std::uint64_t seed, std::uint64_t restart) {
    std::uint64_t bits = seed + 0x9E3779B97F4A7C15U * (restart + 1);
    bits = (bits ^ (bits >> 30U)) * 0xBF58476D1CE4E5B9U;
    bits = (bits ^ (bits >> 27U)) * 0x94D049BB133111EBU;
    return bits ^ (bits >> 31U);
}

/// Uniform in [0, 1) from raw bits: std::uniform_real_distribution differs between platforms.
double unit_random(std::mt19937_64& engine) {
    return static_cast<double>(engine() >> 11U) * 0x1.0p-53;
}

/// k-means++: each next centre is a point drawn with a probability proportional to its squared distance to
/// the centres so far. Stops early when every point already is a centre.
std::vector<Point> draw_centres(const std::vector<Point>& points, std::uint32_t count,
                                std::mt19937_64& engine) {
    const auto last = points.size() - 1;
    const auto first = static_cast<std::size_t>(unit_random(engine) * static_cast<double>(points.size()));
    std::vector<Point> centres{points[std::min(first, last)]};
    std::vector<double> squared(points.size(), std::numeric_limits<double>::infinity());
    while (centres.size() < count) {
        double total = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            squared[i] = std::min(squared[i], squared_distance(points[i], centres.back()));
            total += squared[i];
        }
        if (total <= 0) break;
        double left = unit_random(engine) * total;
        std::size_t chosen = points.size();
        for (std::size_t i = 0; i < points.size() && left >= 0; ++i) {
            if (squared[i] > 0) chosen = i;  // rounding may leave a rest behind the last point
            left -= squared[i];
        }
        centres.push_back(points[chosen]);
    }
    return centres;
}

struct Run {
    std::vector<Point> centres;
    std::vector<double> history;
    double inertia = 0;
    bool converged = false;
};

std::size_t farthest_point(const std::vector<Point>& points, const std::vector<Point>& centres) {
    std::size_t farthest = 0;
    double largest = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double distance = squared_distance(points[i], centres[closest_centre(points[i], centres)]);
        if (distance > largest) {
            largest = distance;
            farthest = i;
        }
    }
    return farthest;
}

/// Moves every centre to the mean of its points, and one centre without points (if any) to the farthest
/// point. Returns the largest movement.
double move_centres(const PointTree& tree, const AssignmentSums& sums, std::vector<Point>& centres) {
    const std::vector<Point> before = centres;
    double largest_squared = 0;
    bool reseeded = false;
    for (std::size_t c = 0; c < centres.size(); ++c) {
        const auto count = static_cast<double>(sums.count[c]);
        if (sums.count[c] > 0) {
            for (int axis = 0; axis < 3; ++axis)
                centres[c][axis] = sums.position_sum_m[c][axis] / count;
        } else if (!reseeded) {
            centres[c] = tree.points_m()[farthest_point(tree.points_m(), before)];
            reseeded = true;
        }
        largest_squared = std::max(largest_squared, squared_distance(centres[c], before[c]));
    }
    return std::sqrt(largest_squared);
}

Run run_once(const PointTree& tree, const KmeansOptions& options, std::uint32_t clusters,
             std::uint32_t restart) {
    std::mt19937_64 engine(seed_of_restart(options.seed, restart));
    Run run;
    run.centres = draw_centres(tree.points_m(), clusters, engine);
    const double standstill_m = kStandstill * tree.diagonal_m();
    while (!run.converged && run.history.size() < options.max_iterations) {
        const AssignmentSums sums = tree.assign(run.centres);
        run.history.push_back(sums.inertia_m2);
        run.converged = move_centres(tree, sums, run.centres) <= standstill_m;
    }
    run.inertia = tree.assign(run.centres).inertia_m2;
    return run;
}

/// Labels every point and leaves out centres without points.
KmeansResult label_points(const PointTree& tree, Run run) {
    const std::size_t count = tree.points_m().size();
    KmeansResult result;
    result.cluster_of_point.resize(count);
    std::vector<std::uint32_t> new_index(run.centres.size(), 0);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t centre = closest_centre(tree.points_m()[i], run.centres);
        result.cluster_of_point[tree.original_index()[i]] = centre;
        new_index[centre] = 1;
    }
    std::uint32_t used = 0;
    for (std::size_t c = 0; c < run.centres.size(); ++c) {
        if (new_index[c] == 0) continue;
        new_index[c] = used++;
        Point centre = run.centres[c];
        for (int axis = 0; axis < 3; ++axis)
            centre[axis] += tree.origin_m()[axis];
        result.centres_m.push_back(centre);
    }
    for (std::uint32_t& cluster : result.cluster_of_point)
        cluster = new_index[cluster];
    result.inertia_m2 = run.inertia;
    result.inertia_history_m2 = std::move(run.history);
    result.converged = run.converged;
    return result;
}

}  // namespace

KmeansResult kmeans(std::span<const Point> points, const KmeansOptions& options) {
    const PointTree tree(points);
    const auto clusters = static_cast<std::uint32_t>(std::min<std::size_t>(options.clusters, points.size()));
    std::vector<Run> runs(options.restarts);
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, options.restarts, 1), [&](const auto& range) {
        for (std::uint32_t restart = range.begin(); restart < range.end(); ++restart)
            runs[restart] = run_once(tree, options, clusters, restart);
    });
    const auto best = std::min_element(runs.begin(), runs.end(),
                                       [](const Run& a, const Run& b) { return a.inertia < b.inertia; });
    return label_points(tree, std::move(*best));
}

}  // namespace knead::tools
