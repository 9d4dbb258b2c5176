// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/model.h"
#include "core/node_field.h"
#include "core/simd/kernels.h"

namespace knead::core {

struct TetStrip;

/// The corotational linear tetrahedra (Mueller and Gross 2004): forces and their linearisation.
///
/// Energy of one tetrahedron: volume * (mu |F - R|^2 + lambda / 2 * tr(R^T F - I)^2) with R the rotation
/// nearest to F (rotation.h); the force is its exact negative gradient. The stiffness K(R) is that of linear
/// elasticity turned by R: symmetric, positive semidefinite in every state, and not assembled. S is float or
/// double. Allocates in the constructor only.
template <class S>
class Elements {
  public:
    Elements(const Model& model, const Kernels& kernels);

    /// Forgets the rotations: at rest.
    void reset() noexcept;

    /// Linearises at rest + `u` (m). @param forces overwritten with scale * the elastic force on every node
    /// (N)
    void linearise(S scale, const NodeField<S>& u, NodeField<S>& forces) noexcept;

    /// out += scale * K(R) u, at the state that was linearised last.
    void add_stiffness(S scale, const NodeField<S>& u, NodeField<S>& out) noexcept {
        kernels_.apply_stiffness(view(), scale, u.data(), out.data());
    }

    [[nodiscard]] Quat rotation(std::size_t element) const noexcept;
    /// Where the w of its rotation stands in rotations(); x, y, z follow at distances of rotation_stride().
    [[nodiscard]] std::uint32_t rotation_place(std::size_t element) const noexcept {
        return rotation_at_[element];
    }
    [[nodiscard]] std::size_t rotation_stride() const noexcept { return kernels_.width; }

    /// For save and restore: w, x, y, z of every tetrahedron and of the lanes without one.
    [[nodiscard]] AlignedArray<S>& rotations() noexcept { return rotations_; }
    [[nodiscard]] const AlignedArray<S>& rotations() const noexcept { return rotations_; }

  private:
    void add(const Model& model, const TetStrip& strip, std::size_t block, std::size_t lane);
    ElementArrays<S> view() noexcept;

    const ElementKernels<S>& kernels_;
    std::size_t blocks_ = 0;
    std::vector<std::uint32_t> rotation_at_;  ///< [elements] where in rotations_
    AlignedArray<std::int32_t> nodes_;
    AlignedArray<S> rest_inverse_, lame_volume_;
    AlignedArray<S> rotations_, gradients_;
};

}  // namespace knead::core
