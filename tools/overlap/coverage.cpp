// SPDX-License-Identifier: GPL-3.0-or-later
#include "overlap/coverage.h"

#include <algorithm>
#include <cmath>

#include "overlap/prepared_tet.h"

namespace knead::tools {
namespace {

MeshCoverage coverage_from(const std::vector<double>& shared_m3, const std::vector<double>& volumes_m3) {
    MeshCoverage coverage;
    double total = 0;
    double covered = 0;
    for (std::size_t i = 0; i < volumes_m3.size(); ++i) {
        const auto id = static_cast<std::uint32_t>(i);
        const double share = shared_m3[i] / volumes_m3[i];
        const double error = std::abs(share - 1);
        total += volumes_m3[i];
        covered += std::min(shared_m3[i], volumes_m3[i]);
        if (error <= kFullCoverageTolerance) {
            ++coverage.full;
            coverage.largest_full_error = std::max(coverage.largest_full_error, error);
        }
        if (share < kIncompleteBelow) coverage.incomplete.add(id);
        if (share == 0) coverage.uncovered.add(id);
        if (share > 1 + kFullCoverageTolerance) coverage.overlapped.add(id);
    }
    coverage.covered_share = total > 0 ? covered / total : 0;
    return coverage;
}

}  // namespace

Coverage coverage_of(const OverlapMatrix& overlap, const TetMesh& fine, const TetMesh& coarse,
                     unsigned threads) {
    std::vector<double> fine_shared(overlap.fine_count);
    std::vector<double> coarse_shared(overlap.coarse_count);
    for (std::size_t j = 0; j < coarse_shared.size(); ++j)
        for (std::uint64_t entry = overlap.row_offsets[j]; entry < overlap.row_offsets[j + 1]; ++entry) {
            coarse_shared[j] += overlap.volumes_m3[entry];
            fine_shared[overlap.columns[entry]] += overlap.volumes_m3[entry];
        }
    return {coverage_from(fine_shared, accurate_volumes_m3(fine, threads)),
            coverage_from(coarse_shared, accurate_volumes_m3(coarse, threads))};
}

}  // namespace knead::tools
