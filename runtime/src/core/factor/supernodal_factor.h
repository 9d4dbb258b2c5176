// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/factor/front_factoriser.h"
#include "core/factor/rest_matrix.h"

namespace knead::core {

/// A factor of a symmetric positive definite matrix over nodes, and solves with it: the preconditioner of the
/// haptic-rate solver.
///
/// Supernodal A^-1 = G^T G, where G is a product of dense panels [W; -L_R W], one for each supernode: a solve
/// is two dense matrix-vector products for each and nothing else. Whatever the rounding of the panels, fixed
/// point included, what is applied is symmetric and positive semidefinite. The analysis of the pattern
/// happens once, in the constructor; the numbers can be computed anew at any time, in bounded pieces, while
/// solves go on with the old ones. Allocates in the constructor only.
///
/// The matrix is a RestMatrix's: of 3 x 3 blocks, or one number for each pair of nodes; solves take three
/// numbers for each node in both cases.
class SupernodalFactor {
  public:
    /// Vectors of a solve; one for each solve that may run at the same time.
    class Scratch {
      public:
        explicit Scratch(const SupernodalFactor& factor);

      private:
        friend class SupernodalFactor;
        AlignedArray<float> single_;
        AlignedArray<double> double_;
    };

    /// @param block_size rows of a block, 3 or 1
    SupernodalFactor(const MatrixPattern& pattern, int block_size, FactorStorage storage,
                     SimdTarget target = best_simd_target());
    SupernodalFactor(const SupernodalFactor&) = delete;
    SupernodalFactor& operator=(const SupernodalFactor&) = delete;

    /// Starts to compute the numbers anew; drops a computation under way.
    /// @param values as RestMatrix::values(); to stay as they are until advance() is done
    void begin(const double* values) noexcept;

    /// Does about `work` floating-point operations, at most largest_piece() more. Which pieces depends on
    /// nothing but the pattern, the result not even on `work`. Done: solves use the new numbers from now on.
    /// Refused: they stay with the old ones.
    Progress advance(std::uint64_t work) noexcept;

    /// The same, but done leaves the new numbers staged: solves stay with the old ones until adopt().
    Progress advance_staged(std::uint64_t work) noexcept;
    [[nodiscard]] bool staged() const noexcept { return staged_; }
    /// Solves use the staged numbers from now on. No effect if there are none.
    void adopt() noexcept;

    /// begin() and all of advance(). @return false: refused
    bool factorise(const double* values) noexcept;

    /// Whether there are numbers to solve with.
    [[nodiscard]] bool ready() const noexcept { return ready_; }
    [[nodiscard]] FactorStorage storage() const noexcept { return storage_; }
    [[nodiscard]] std::uint32_t node_count() const noexcept { return symbolic_.node_count(); }
    /// Floating-point operations that advance() may do beyond what it was asked for.
    [[nodiscard]] std::uint64_t largest_piece() const noexcept { return fronts_.largest_piece(); }
    /// Of the factor that solves read.
    [[nodiscard]] std::size_t panel_bytes() const noexcept { return panels_[0].bytes(); }
    /// Of everything that is kept.
    [[nodiscard]] std::size_t bytes() const noexcept;
    [[nodiscard]] const SymbolicFactor& symbolic() const noexcept { return symbolic_; }

    /// x = A^-1 rhs. @param rhs [nodes][3], may be x  @pre ready(), storage() is not double_precision
    void solve(const float* rhs, float* x, Scratch& scratch) const noexcept;
    /// The same in double. @pre ready(), storage() is double_precision
    void solve(const double* rhs, double* x, Scratch& scratch) const noexcept;
    /// Three vectors [3][nodes][3] at once, the factor read once. @pre solves_three_directions()
    void solve_three(const float* rhs, float* x, Scratch& scratch) const noexcept;
    void solve_three(const double* rhs, double* x, Scratch& scratch) const noexcept;
    /// Whether solve_three() is there; a factor with one number for each pair of nodes has it in solve().
    [[nodiscard]] bool solves_three_directions() const noexcept { return layout_.block == 3; }
    /// The same with the newest numbers: those that are staged, if any.
    void solve_newest(const float* rhs, float* x, Scratch& scratch) const noexcept;
    void solve_newest(const double* rhs, double* x, Scratch& scratch) const noexcept;
    void solve_three_newest(const float* rhs, float* x, Scratch& scratch) const noexcept;
    void solve_three_newest(const double* rhs, double* x, Scratch& scratch) const noexcept;

  private:
    [[nodiscard]] FactorView view(int which) const noexcept;
    [[nodiscard]] int newest() const noexcept { return staged_ ? 1 - current_ : current_; }

    const FactorKernels& kernels_;
    const FactorStorage storage_;
    const FactorLayout layout_;
    const SymbolicFactor symbolic_;
    std::size_t own_stride_ = 0;
    FrontFactoriser fronts_;
    AlignedArray<unsigned char> panels_[2];
    AlignedArray<float> units_[2], diagonals_[2];  ///< fixed point only
    int current_ = 0;                              ///< of those; the other is the job's
    bool ready_ = false;
    bool staged_ = false;
    bool refused_ = true;  ///< what the job said last
};

}  // namespace knead::core
