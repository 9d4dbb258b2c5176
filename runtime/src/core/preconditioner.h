// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/system.h"

namespace knead::core {

/// Block Jacobi: the inverse of every node's 3 x 3 diagonal block, and of the tool's.
///
/// The solver asks three things of a preconditioner: refresh() once per linearisation, hold() whenever the
/// set of held nodes changed, apply(). Allocates in the constructor only.
class BlockJacobi {
  public:
    explicit BlockJacobi(const Model& model);

    /// Takes the diagonal of `system`, whatever is held.
    void refresh(const System& system) noexcept;

    /// Takes the held nodes of `system` into account.
    void hold(const System& system) noexcept;

    /// @param residual projected  @param out expanded
    void apply(const System& system, const Unknowns& residual, Unknowns& out) const noexcept;

    /// The stiffness that the tool feels with all other nodes still, N/m: bounds how its force reacts to
    /// them.
    [[nodiscard]] const Mat& tool_stiffness_n_per_m() const noexcept { return tool_stiffness_; }

  private:
    std::vector<Mat> inverse_blocks_;
    Mat tool_stiffness_ = Mat::Zero();
    Mat tool_inverse_ = Mat::Zero();
    std::vector<Mat> columns_;
    std::vector<std::uint8_t> marked_;
};

using Preconditioner = BlockJacobi;

}  // namespace knead::core
