// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/factor/matrix_pattern.h"
#include "core/simd/factor_kernels.h"

namespace knead::core {

/// Which columns of a factor are computed together, and where what is not zero will be.
///
/// Nodes stand at *places*: the order of the pattern, rearranged without more fill so that the columns of a
/// supernode are consecutive and every subtree of supernodes is too (children before parents, in postorder).
/// Source: Liu, The role of elimination trees in sparse factorization (1990); Ashcraft and Grimes, The
/// influence of relaxed supernode partitions (1989).
struct SymbolicFactor {
    static constexpr std::uint32_t kNoParent = 0xffffffff;

    std::vector<std::uint32_t> place_of;            ///< [nodes]
    std::vector<FactorView::Supernode> supernodes;  ///< ascending places
    std::vector<std::uint32_t> parents;             ///< [supernodes] kNoParent: a root
    std::vector<std::uint32_t> rows;                ///< places below each supernode's columns, ascending
    std::size_t value_count = 0;                    ///< numbers stored for all supernodes

    [[nodiscard]] std::uint32_t node_count() const noexcept {
        return static_cast<std::uint32_t>(place_of.size());
    }
};

/// @param layout how panels are stored; decides which small supernodes are worth merging
SymbolicFactor analyse(const MatrixPattern& pattern, const FactorLayout& layout);

}  // namespace knead::core
