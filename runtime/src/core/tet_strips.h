// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model.h"
#include "core/simd/element_kernels.h"

namespace knead::core {

/// Up to three tetrahedra that are processed together, because they share nodes (element_kernels.h).
struct TetStrip {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    /// kNone behind the last one.
    std::array<std::uint32_t, kTetsInStrip> elements{kNone, kNone, kNone};
    /// Tetrahedron k consists of nodes 0, k + 1, k + 2, k + 3 of these. kNone behind the last one. A node may
    /// stand twice, as the second and the last: three tetrahedra may close a ring round an edge.
    std::array<std::uint32_t, kTetsInStrip + 3> nodes{kNone, kNone, kNone, kNone, kNone, kNone};
};

/// Every tetrahedron in one strip; strips in the order of their first tetrahedron in the list.
///
/// Any path of three tetrahedra, each sharing a face with the next, is a strip. Paths are taken greedily,
/// tetrahedra with few free neighbours first, then repaired: one that was left over changes places with
/// others until it fits somewhere. Nearly all are full then, whatever the mesh; that is speed, not
/// correctness.
std::vector<TetStrip> make_tet_strips(const std::vector<Element>& elements);

}  // namespace knead::core
