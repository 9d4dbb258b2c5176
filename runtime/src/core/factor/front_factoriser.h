// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/factor/aligned_array.h"
#include "core/factor/symbolic_factor.h"
#include "core/simd/kernels.h"

namespace knead::core {

/// Whether a job has more to do.
enum class Progress : std::uint8_t {
    working,
    done,
    refused,  ///< the matrix is not positive definite, not finite, or too large for the storage
};

/// Computes the numbers of a factor in double precision, a bounded piece at a time: the multifrontal method.
///
/// Every supernode has a front, a dense symmetric matrix over its columns and rows: its columns of A and what
/// its children leave. The front's columns are eliminated, strip by strip; what remains of the front waits on
/// a stack for the parent. Allocates in the constructor only.
/// Source: Duff and Reid, The multifrontal solution of indefinite sparse symmetric linear equations (1983).
class FrontFactoriser {
  public:
    FrontFactoriser(const MatrixPattern& pattern, const SymbolicFactor& symbolic, const FactorLayout& layout,
                    FactorStorage storage, const FactorKernels& kernels);

    /// @param values blocks of the pattern's entries, column-major; to stay as they are until the end
    /// @param panels where the factor goes
    /// @param units, diagonal [nodes * block] as in FactorView; fixed point only
    void begin(const double* values, void* panels, float* units, float* diagonal) noexcept;

    /// Does pieces of work until about `work` floating-point operations are done (at least one piece).
    Progress advance(std::uint64_t work) noexcept;

    /// Floating-point operations of the largest piece.
    [[nodiscard]] std::uint64_t largest_piece() const noexcept;
    [[nodiscard]] std::size_t bytes() const noexcept { return stack_.bytes() + strip_.bytes(); }

  private:
    /// What is done to a front, in this order.
    enum class Stage : std::uint8_t { clear, matrix, child, pivot, update, invert, keep, next };

    /// A block of the matrix that belongs to a column: at `row` (a place), number `entry` of the pattern.
    struct Entry {
        std::uint32_t row;
        std::uint32_t entry;
    };
    /// The front of the supernode under way.
    struct Front {
        std::size_t columns, rows, size;  ///< numbers; size = columns + rows
        std::size_t width, ld;
        double* data;
    };

    void sort_entries(const MatrixPattern& pattern);
    void size_stack();
    [[nodiscard]] Front front_of(std::size_t supernode, double* data) const noexcept;
    [[nodiscard]] static std::size_t padded(std::size_t numbers) noexcept;

    void open() noexcept;
    std::uint64_t piece() noexcept;
    std::uint64_t clear() noexcept;
    std::uint64_t add_matrix() noexcept;
    std::uint64_t add_child() noexcept;
    std::uint64_t eliminate_strip() noexcept;
    std::uint64_t update_strip() noexcept;
    std::uint64_t invert_strip() noexcept;
    void store_strip() noexcept;
    std::uint64_t keep_rest() noexcept;
    [[nodiscard]] std::size_t width_at(std::size_t column) const noexcept;
    [[nodiscard]] double* inverse_at(std::size_t column) noexcept;

    const SymbolicFactor& symbolic_;
    const FactorLayout layout_;
    const FactorStorage storage_;
    const FactorKernels& kernels_;
    std::vector<std::uint32_t> entry_begin_;  ///< [places + 1]
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> child_begin_, children_;
    std::vector<std::size_t> stack_begin_;  ///< [supernodes] where what remains of its front is kept

    const double* values_ = nullptr;
    void* panels_ = nullptr;
    float* units_ = nullptr;
    float* diagonal_ = nullptr;
    std::vector<std::uint32_t> local_;  ///< [places] number of the row in the front under way
    AlignedArray<double> stack_, strip_, inverses_;

    // Where the job is.
    std::size_t supernode_ = 0;
    Stage stage_ = Stage::next;
    std::size_t at_ = 0, inner_ = 0;  ///< column, child or strip, depending on the stage
    std::size_t panel_offset_ = 0;
    bool refused_ = false;
    Front front_{};
};

}  // namespace knead::core
