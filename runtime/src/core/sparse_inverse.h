// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/factor/matrix_pattern.h"
#include "core/node_field.h"
#include "core/simd/kernels.h"

namespace knead::core {

/// A cheap approximate inverse of a symmetric positive definite matrix of 3 x 3 blocks: A^-1 ~ G^T G with G
/// as sparse as the lower triangle of A.
///
/// Row i of G is what the Cholesky factor of the small matrix over node i and its earlier neighbours says of
/// node i. Good where the inverse reaches no farther than the neighbours, which is where mass outweighs
/// stiffness (short steps, soft matter, coarse meshes); positive definite whatever the numbers. Rows depend
/// on nothing but A and can be made anew one by one. S is float or double. Allocates in the constructor only.
/// Source: Kolotilina and Yeremin, Factorized sparse approximate inverse preconditionings I (1993).
template <class S>
class SparseInverse {
  public:
    /// @param pattern outlives this
    SparseInverse(const MatrixPattern& pattern, const Kernels& kernels);

    /// Makes rows [first, last) anew. @param values of the pattern, as RestMatrix::values()
    void make(const double* values, std::uint32_t first, std::uint32_t last) noexcept;

    /// out = G^T G v. @param out may be v
    void apply(const NodeField<S>& v, NodeField<S>& out) const noexcept;

    [[nodiscard]] std::uint32_t row_count() const noexcept { return pattern_.node_count; }
    /// Floating-point operations of the largest row.
    [[nodiscard]] std::uint64_t largest_row() const noexcept { return most_ * most_ * most_ / 3; }
    [[nodiscard]] std::size_t bytes() const noexcept { return lower_.blocks.bytes() + upper_.blocks.bytes(); }

  private:
    void make_row(const double* values, std::uint32_t row) noexcept;
    void gather(const double* values, std::uint32_t row) noexcept;

    /// G or G^T in the order of the kernels.
    struct Groups {
        std::vector<std::uint32_t> begin;
        std::vector<std::int32_t> rows, columns;
        AlignedArray<S> blocks;
        /// [blocks of the matrix, row by row] where column 0 of the block begins.
        std::vector<std::uint32_t> place;
    };

    void arrange(const std::vector<std::uint32_t>& row_begin, const std::vector<std::uint32_t>& columns,
                 Groups& groups) const;
    [[nodiscard]] static BlockGroups<S> view(const Groups& groups) noexcept;

    const MatrixPattern& pattern_;
    const SparseKernels<S>& kernels_;
    std::vector<std::uint32_t> row_begin_;  ///< [nodes + 1] of G
    std::vector<std::uint32_t> nodes_;      ///< [blocks] column, ascending, the last of each row the diagonal
    std::vector<std::uint32_t> mirror_;     ///< [blocks] where G^T has the block
    Groups lower_, upper_;                  ///< G, G^T
    mutable NodeField<S> between_;
    std::size_t most_ = 0;  ///< rows of the largest small matrix
    std::vector<double> small_, solution_;
    static constexpr std::uint32_t kElsewhere = ~std::uint32_t{0};
    std::vector<std::uint32_t> local_;  ///< [nodes] place in the row that is being made
};

}  // namespace knead::core
