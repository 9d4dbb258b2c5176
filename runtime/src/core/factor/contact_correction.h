// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/factor/supernodal_factor.h"

namespace knead::core {

/// A node that a tool holds, as the preconditioner sees it.
struct HeldNode {
    std::uint32_t node = 0;
    std::uint32_t tool = 0;
    Mat held = Mat::Identity();      ///< projector: identity (sticking) or n n^T (sliding), scene frame
    Mat rotation = Mat::Identity();  ///< from the factor's frame at the node to the scene's
};

/// The preconditioner while tools hold nodes: a factor that knows nothing of them, corrected by the Schur
/// complement on the held ones.
///
/// With P = blkdiag(A^-1, tool inverses), the rows J of the held directions (the node's motion minus its
/// tool's) and W = J P J^T, it is P - P J^T W^-1 J P: what a factor made for that set would give. W comes
/// from a table of A^-1 for all nodes that can be touched; its inverse is kept for the nodes that have been
/// *taken in* and bordered as nodes enter and leave. A node that is held but not taken in is left to the
/// caller's projection, before and after; the whole stays symmetric and positive semidefinite. So it does
/// while normals or rotations have turned since the node was taken in.
///
/// Vectors of nodes are in the factor's frame, three numbers for each node; those of tools in the scene's.
/// Allocates in the constructor only.
class ContactCorrection {
  public:
    /// Vectors of an application; one for each that may run at the same time.
    class Scratch {
      public:
        explicit Scratch(const ContactCorrection& correction);

      private:
        friend class ContactCorrection;
        SupernodalFactor::Scratch solve_;
        AlignedArray<float> single_;
        AlignedArray<double> double_;
        AlignedArray<double> reactions_;  ///< two vectors of rows
        std::vector<const float*> columns_;
        std::vector<float> factors_;
        std::vector<Vec> tools_;
    };

    /// @param touchable unknown nodes, each once: those that can be taken in
    /// @param tool_count numbers of tools in HeldNode::tool
    /// @param column_bytes keep whole columns of A^-1 if they take no more than this (twice: the new ones
    /// while they are made): they make applications with few held nodes cheaper
    ContactCorrection(SupernodalFactor& factor, const std::vector<std::uint32_t>& touchable,
                      std::size_t tool_count, std::size_t column_bytes = kColumnBytes,
                      SimdTarget target = best_simd_target());
    ContactCorrection(const ContactCorrection&) = delete;
    ContactCorrection& operator=(const ContactCorrection&) = delete;

    /// Starts to make the table for the factor's newest numbers (those staged, or else those in use).
    void begin() noexcept;
    /// Does solves until about `work` floating-point operations are done, at least one.
    Progress advance(std::uint64_t work) noexcept;
    /// Takes the finished table into use, and the factor's staged numbers with it. Nothing is taken in then.
    void adopt() noexcept;
    /// begin(), all of advance(), adopt().
    void build() noexcept;

    /// Follows the set of held nodes: who is no longer held, is held otherwise or has turned too far leaves
    /// at once, at most `most_insertions` enter, first in the list first.
    /// @param tool_inverses [tool_count] A moving tool's own part of P, 1/kg, scene frame; zero: does not
    /// move
    /// @return whether all that can be taken in have been
    bool update(const HeldNode* held, std::size_t count, const Mat* tool_inverses,
                std::size_t most_insertions) noexcept;
    /// Nothing is taken in.
    void clear() noexcept;

    /// @param rhs [nodes][3]  @param tool_rhs [tool_count]  @param x, tool_x out; x is not rhs
    /// @pre the table is in use; factor().storage() is not double_precision for float, and is for double
    void apply(const float* rhs, const Vec* tool_rhs, float* x, Vec* tool_x, Scratch& scratch) const noexcept;
    void apply(const double* rhs, const Vec* tool_rhs, double* x, Vec* tool_x,
               Scratch& scratch) const noexcept;

    /// How the held rows of a tool that does not move answer to its motion, kg: stiffness times dt^2 plus
    /// inertia, of the nodes taken in.
    [[nodiscard]] Mat reaction_kg(std::uint32_t tool) const noexcept;

    [[nodiscard]] std::size_t taken_in() const noexcept { return members_.size(); }
    [[nodiscard]] bool takes(std::uint32_t node) const noexcept { return touch_of_[node] != kNone; }
    [[nodiscard]] bool has_columns() const noexcept { return keeps_columns_; }
    [[nodiscard]] std::size_t bytes() const noexcept;
    [[nodiscard]] SupernodalFactor& factor() noexcept { return factor_; }

    static constexpr std::size_t kColumnBytes = std::size_t{16} << 20;

  private:
    static constexpr std::uint32_t kNone = 0xffffffff;

    /// A held node that is part of the inverse: rows [first, first + count).
    struct Member {
        std::uint32_t touch, node, tool;
        std::size_t first, count;
    };
    /// A held direction, seen by the node and by the tool.
    struct Row {
        Vec at_node, at_tool;
    };

    template <class S>
    std::uint64_t make_columns(std::uint32_t touch, AlignedArray<S>& rhs, AlignedArray<S>& x) noexcept;
    template <class S>
    void apply_to(const S* rhs, const Vec* tool_rhs, S* x, Vec* tool_x, AlignedArray<S>& copy,
                  Scratch& scratch) const noexcept;
    template <class S>
    void find_reactions(const S* y, const Vec* tool_rhs, Scratch& scratch) const noexcept;
    void subtract_columns(const double* reactions, float* x, Scratch& scratch) const noexcept;
    [[nodiscard]] bool columns_pay() const noexcept;

    [[nodiscard]] double table(std::uint32_t row, int r, std::uint32_t column, int c) const noexcept;
    [[nodiscard]] bool still_holds(const Member& member, const HeldNode& held) const noexcept;
    void remove_stale(const HeldNode* held, std::size_t count) noexcept;
    bool insert(const HeldNode& held) noexcept;
    void remove(std::size_t member) noexcept;
    void coupling(const Member& a, const Member& b, double* block, std::size_t ld) const noexcept;
    [[nodiscard]] std::size_t row_count() const noexcept { return rows_.size(); }

    SupernodalFactor& factor_;
    const FactorKernels& kernels_;
    const std::vector<std::uint32_t> touchable_;
    std::vector<std::uint32_t> touch_of_;  ///< [nodes] index in touchable_, or kNone
    const bool keeps_columns_;
    std::size_t column_stride_;      ///< numbers from one column to the next
    AlignedArray<float> tables_[2];  ///< [touchable][3] columns of A^-1: all rows, or those touchable
    int current_ = 0;
    bool in_use_ = false;

    // What is taken in.
    std::vector<Member> members_;
    std::vector<Row> rows_;
    std::vector<Mat> tool_inverses_;
    std::vector<std::uint32_t> member_of_;  ///< [touchable] or kNone
    std::vector<std::uint32_t> wanted_;     ///< [touchable] index in the list that update() got, or kNone
    std::size_t ld_ = 0;
    AlignedArray<double> inverse_;  ///< of W, column-major
    AlignedArray<double> border_, product_, weighted_;

    // The job.
    SupernodalFactor::Scratch solve_;
    AlignedArray<float> rhs_single_, x_single_;
    AlignedArray<double> rhs_double_, x_double_;
    std::size_t next_ = 0;
    bool made_ = false;
};

}  // namespace knead::core
