// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "aggregate/interest.h"
#include "knead/formats/clustering.h"

namespace knead::tools {

/// Which bin grows first. The last bin gets what the others leave.
enum class BinOrder : std::uint8_t { stiff_first, soft_first };

struct AggregateOptions {
    BinOrder order = BinOrder::stiff_first;
    InterestKind interest = InterestKind::combined;
    double direction_weight = 0.25;  ///< w of InterestKind, finite and >= 0, otherwise bad_usage
};

/// Volume of one elasticity bin before and after; they differ by at most one tetrahedron per cluster grown.
struct BinVolume {
    double before_m3 = 0;
    double after_m3 = 0;
};

struct AggregateResult {
    Material material;            ///< of every tetrahedron: its bin and the bin's homogenised values
    std::vector<BinVolume> bins;  ///< [bins]
    /// How often a cluster found nothing more to cross and went on at the nearest unmodified tetrahedron.
    std::uint64_t jumps = 0;
};

/// Phase P3, Algorithm 1: gathers the elasticity of every bin around the barycentres of its clusters.
///
/// Bin after bin, cluster after cluster (in index order): starts at the tetrahedron that contains the
/// cluster's barycentre (none: the nearest), grows over faces by the lowest interest, and gives the bin's
/// elasticity to each tetrahedron not yet modified until the cluster's volume is reached. Modified tetrahedra
/// are crossed and not counted. The last bin takes the rest. Only values move; the mesh stays. Ties go to the
/// lower index.
/// @param object valid
/// Source: paper section 3.2, "Aggregation", Algorithm 1.
[[nodiscard]] AggregateResult aggregate(const ClusteredObject& object, const AggregateOptions& options);

}  // namespace knead::tools
