// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "knead/formats/result.h"

namespace knead {

/// Volume shared by every coarse tetrahedron with every fine one, in compressed rows.
///
/// Row j is coarse tetrahedron j; column i is fine tetrahedron i. Written by knead-overlap, read by
/// knead-coarsen. On disk: group "/knead/overlap" (docs/format.md).
/// Source: paper section 3.2, "Geometric coarsening"; C_ij = volumes_m3 / volume of the fine tetrahedron.
///
/// Invariants, checked by validate() and again by every reader:
///   - row_offsets has coarse_count + 1 entries, starts at 0, never decreases, ends at columns.size()
///   - within a row, columns strictly increase and are < fine_count
///   - every volume is finite and > 0; pairs that only touch are not stored
struct OverlapMatrix {
    std::uint32_t coarse_count = 0;
    std::uint32_t fine_count = 0;
    std::vector<std::uint64_t> row_offsets;  ///< [coarse_count + 1]
    std::vector<std::uint32_t> columns;      ///< [nnz] fine tetrahedron index
    std::vector<double> volumes_m3;          ///< [nnz] cubic metres, > 0
};

/// Checks every invariant above.
[[nodiscard]] Status validate(const OverlapMatrix& overlap);

}  // namespace knead
