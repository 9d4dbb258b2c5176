// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cluster/binning.h"
#include "knead/formats/clustering.h"

namespace knead::tools {

struct ClusterOptions {
    std::uint32_t bins = 2;      ///< >= 1, otherwise bad_usage
    std::uint32_t clusters = 3;  ///< per bin, >= 1, otherwise bad_usage; capped by the bin's tetrahedra
    Binning binning = Binning::equal_width;
    std::uint32_t restarts = 5;  ///< of k-means in each bin, >= 1, otherwise bad_usage
    std::uint64_t seed = 1;
};

/// How k-means went in one bin.
struct BinReport {
    std::uint32_t tetrahedra = 0;
    std::uint32_t clusters = 0;
    std::uint32_t iterations = 0;  ///< of the winning restart
    bool converged = false;
    double inertia_m2 = 0;
    double volume_m3 = 0;
    double lowest_youngs_modulus_pa = 0;
    double highest_youngs_modulus_pa = 0;
};

struct ClusterResult {
    Clustering clustering;
    std::vector<BinReport> bins;  ///< [bins], softest first
};

/// Phases P1 and P2: elasticity bins, k-means clusters inside each bin, and the bin's homogenised values.
///
/// k-means works on the barycentres of the tetrahedra, each with the same weight, and its own centres are the
/// plain means. The barycentre that goes into the result, where aggregation will start, is weighted by
/// volume. Homogenised values are volume-weighted means. Runs on the threads of the current TBB arena; the
/// result does not depend on their number.
/// @param mesh, material valid
/// Source: paper section 3.2, "Initialization" and "Homogenization".
[[nodiscard]] ClusterResult cluster_object(const TetMesh& mesh, const Material& material,
                                           const ClusterOptions& options);

}  // namespace knead::tools
