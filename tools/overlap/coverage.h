// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "knead/formats/overlap.h"
#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// An element is told about when it misses more than this share of its volume.
inline constexpr double kIncompleteBelow = 0.99;
/// An element counts as fully covered when its share is 1 within this, as overlapped when above 1 by more.
/// Meshes on both sides of a common surface differ by rounding only: far less than this.
inline constexpr double kFullCoverageTolerance = 1e-9;
/// How many element ids a list holds at most.
inline constexpr std::size_t kFirstIds = 10;

/// Some elements of a mesh: how many, and the first ids (0-based).
struct ElementSample {
    std::uint64_t count = 0;
    std::vector<std::uint32_t> first;

    void add(std::uint32_t element) {
        ++count;
        if (first.size() < kFirstIds) first.push_back(element);
    }
};

/// How well the other mesh covers one mesh. The share of an element is the sum of its shared volumes over its
/// own volume: sum_j C_ij for a fine one, sum_i C_ij V_i / V_j for a coarse one.
struct MeshCoverage {
    double covered_share = 0;       ///< of the mesh's volume, in [0, 1]
    std::uint64_t full = 0;         ///< elements whose share is 1
    double largest_full_error = 0;  ///< largest |share - 1| among these
    ElementSample incomplete;       ///< share below kIncompleteBelow (the uncovered ones too)
    ElementSample uncovered;        ///< share 0
    ElementSample overlapped;       ///< share above 1: the other mesh covers them more than once
};

struct Coverage {
    MeshCoverage fine;
    MeshCoverage coarse;
};

/// @pre `overlap` was made from these two meshes
[[nodiscard]] Coverage coverage_of(const OverlapMatrix& overlap, const TetMesh& fine, const TetMesh& coarse,
                                   unsigned threads);

}  // namespace knead::tools
