// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "knead/formats/overlap.h"
#include "knead/formats/tet_mesh.h"
#include "overlap/shared_volume.h"

namespace knead::tools {

struct OverlapOptions {
    /// Shared volumes below this share of the smaller tetrahedron are not stored. In [0, 1). The default is
    /// so small that rows and columns, which miss up to a few dozen such pairs, still sum to 1e-12.
    double drop_below = 1e-14;
    unsigned threads = 1;  ///< >= 1; the result does not depend on it
};

struct OverlapStatistics {
    std::uint64_t candidate_pairs = 0;  ///< pairs whose bounding boxes meet
    ArithmeticCounts arithmetic;        ///< how these pairs were decided
};

/// Volume that each coarse tetrahedron (row) shares with each fine one (column); see OverlapMatrix.
///
/// Every volume is within 1e-12 of the smaller tetrahedron's volume (shared_volume.h). The meshes are taken
/// as they are: they need not match in place, surface or resolution, and nothing is moved or rescaled.
///
/// @pre both meshes are valid (validate(const TetMesh&))
/// @throws ToolError bad_usage if drop_below is out of range
/// @par Source: paper section 3.2, "Geometric coarsening"
[[nodiscard]] OverlapMatrix overlap_volumes(const TetMesh& fine, const TetMesh& coarse,
                                            const OverlapOptions& options,
                                            OverlapStatistics* statistics = nullptr);

}  // namespace knead::tools
