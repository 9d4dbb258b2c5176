// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "core/model.h"
#include "core/node_field.h"
#include "core/simd/kernels.h"

namespace knead::core {

struct TetStrip;

/// The stiffness K(R) of corotational linear tetrahedra (Mueller and Gross 2004) at one state: that of linear
/// elasticity turned by R, symmetric, positive semidefinite in every state, and not assembled.
///
/// V: the numbers of the vectors that it is multiplied with, float or double. Made by Elements.
template <class V>
class Stiffness {
  public:
    /// out += scale * K(R) u.
    void add_product(V scale, const NodeField<V>& u, NodeField<V>& out) const noexcept {
        apply_(view(), scale, u.data(), out.data());
    }

    [[nodiscard]] Quat rotation(std::size_t element) const noexcept;
    /// Where the w of its rotation stands in rotations(); x, y, z follow at distances of rotation_stride().
    [[nodiscard]] std::uint32_t rotation_place(std::size_t element) const noexcept {
        return rotation_at_[element];
    }
    [[nodiscard]] std::size_t rotation_stride() const noexcept { return width_; }
    /// w, x, y, z of every tetrahedron and of the lanes without one.
    [[nodiscard]] const AlignedArray<V>& rotations() const noexcept { return rotations_; }

  protected:
    using Apply = decltype(ElementKernels<V, V>::apply_stiffness);

    Stiffness(const Model& model, const std::vector<TetStrip>& strips, std::size_t width, Apply apply);

    /// Strip `s` is lane `s / blocks` of block `s % blocks`.
    [[nodiscard]] std::size_t blocks() const noexcept { return blocks_; }
    [[nodiscard]] std::size_t width() const noexcept { return width_; }
    [[nodiscard]] StiffnessArrays<V> view() const noexcept;
    [[nodiscard]] AlignedArray<V>& gradients() noexcept { return gradients_; }
    [[nodiscard]] AlignedArray<V>& rotations() noexcept { return rotations_; }

  private:
    void add(const Model& model, const TetStrip& strip, std::size_t block, std::size_t lane);

    const Apply apply_;
    const std::size_t width_;
    std::size_t blocks_ = 0;
    std::vector<std::uint32_t> rotation_at_;  ///< [elements] where in rotations_
    AlignedArray<std::int32_t> nodes_;
    AlignedArray<V> lame_volume_;
    mutable AlignedArray<V> rotations_, gradients_;  ///< written by the kernels of Elements, through view()
};

/// The tetrahedra in the state of a step: their forces, and their stiffness there.
///
/// Energy of one tetrahedron: volume * (mu |F - R|^2 + lambda / 2 * tr(R^T F - I)^2) with R the rotation
/// nearest to F (rotation.h); the force is its exact negative gradient. S: the numbers of the state, float or
/// double; V: those of the solve, S or float. Allocates in the constructor only.
template <class S, class V = S>
class Elements : public Stiffness<V> {
  public:
    /// At rest.
    Elements(const Model& model, const Kernels& kernels);

    /// Forgets the rotations: at rest.
    void reset() noexcept;

    /// Linearises at rest + `u` (m). @param forces overwritten with scale * the elastic force on every node
    /// (N)
    /// @return whether a tetrahedron is inside out there
    bool linearise(S scale, const NodeField<S>& u, NodeField<S>& forces) noexcept;

  private:
    Elements(const Model& model, const std::vector<TetStrip>& strips, const ElementKernels<S, V>& kernels);
    [[nodiscard]] AlignedArray<S>& state() noexcept {
        if constexpr (std::is_same_v<S, V>)
            return this->rotations();
        else
            return state_;
    }

    const ElementKernels<S, V>& kernels_;
    AlignedArray<S> rest_inverse_;
    AlignedArray<S> state_;  ///< rotations; those of the stiffness, if S is V
};

}  // namespace knead::core
