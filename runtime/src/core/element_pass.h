// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model.h"

namespace knead::core {

/// The corotational linear tetrahedra (Mueller and Gross 2004): forces and their linearisation.
///
/// Energy of one tetrahedron: volume * (mu |F - R|^2 + lambda / 2 * tr(R^T F - I)^2) with R the rotation of F
/// (rotation.h); the force is its exact negative gradient. The stiffness K(R) is that of linear elasticity
/// turned by R: symmetric, positive semidefinite in every state, and not assembled. Allocates in the
/// constructor only.
class ElementPass {
  public:
    explicit ElementPass(const Model& model);

    /// Forgets the rotations: at rest.
    void reset() noexcept;

    /// Linearises at `x`. @param forces [nodes] out: elastic force on every node, newtons
    void linearise(const Model& model, const Field& x, Field& forces) noexcept;

    /// @param out [nodes] K(R) u, at the state that was linearised last; N/m times the unit of u
    void apply_stiffness(const Model& model, const Field& u, Field& out) const noexcept;

    /// @param blocks [nodes] out: the 3 x 3 diagonal blocks of K(R), N/m
    void diagonal_blocks(const Model& model, std::vector<Mat>& blocks) const noexcept;

    /// E^T K(R) E for E = `columns` ([nodes], zero where `marked` is 0): the stiffness that a tool feels
    /// which moves node i by columns[i] t. Visits only tetrahedra with a marked node.
    Mat reduced_stiffness(const Model& model, const std::vector<Mat>& columns,
                          const std::vector<std::uint8_t>& marked) const noexcept;

  private:
    std::vector<Quat> rotations_;
    std::vector<Mat> gradients_;  ///< [elements] column k: rotated shape function gradient of node k + 1
};

}  // namespace knead::core
