// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

struct KmeansOptions {
    std::uint32_t clusters = 3;  ///< >= 1; capped by the number of points
    std::uint32_t restarts = 5;  ///< >= 1; the lowest inertia wins, ties: the earlier
    std::uint64_t seed = 1;
    std::uint32_t max_iterations = 1000;  ///< of each restart
};

struct KmeansResult {
    std::vector<std::uint32_t> cluster_of_point;  ///< [points] < centres_m.size()
    std::vector<Point> centres_m;                 ///< [clusters], every one has a point
    double inertia_m2 = 0;                        ///< sum of squared distances to the closest centre
    std::vector<double> inertia_history_m2;       ///< of the winning restart, one per iteration, never rises
    bool converged = false;                       ///< the centres stood still before max_iterations
};

/// k-means with a Euclidean distance, every point with the same weight.
///
/// Started by k-means++ (Arthur and Vassilvitskii, 2007), refined by Lloyd's algorithm until the centres
/// stand still; a centre that loses all its points moves to the point that is farthest from its own centre.
/// Ties are broken by index. Restarts run on the threads of the current TBB arena; the result depends neither
/// on their number nor on the order of the points (as long as no two coincide). Fewer clusters come back when
/// fewer different points exist.
/// @param points not empty, finite
/// Source: paper section 3.2, "Initialization".
[[nodiscard]] KmeansResult kmeans(std::span<const Point> points, const KmeansOptions& options);

}  // namespace knead::tools
