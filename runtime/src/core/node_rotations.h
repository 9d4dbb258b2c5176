// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/elements.h"

namespace knead::core {

/// How far the matter around each free node has turned: the mean of the rotations of its stiffest tetrahedra,
/// each weighted by its stiffness, so that a stiff inclusion in soft matter turns as one body.
///
/// A preconditioner made for the rest state is turned by them ("warped"). They may lag behind the state: only
/// the number of iterations depends on it. S is float or double. Allocates in the constructor only.
template <class S>
class NodeRotations {
  public:
    NodeRotations(const Model& model, const Stiffness<S>& elements, const Kernels& kernels);

    void reset() noexcept;

    /// Takes one of `shares` shares (at most 64) of the nodes anew, the next one with each call.
    /// @param elements the ones of the constructor
    void update(const Stiffness<S>& elements, std::uint32_t shares) noexcept;

    /// out = R^T v: into the rest state's frame. Packed x, y, z, of packed_size(free nodes) numbers.
    void turn_back(const NodeField<S>& v, float* out) const noexcept {
        kernels_.turn_back_to_float(view(), v.data(), out);
    }
    void turn_back(const NodeField<S>& v, double* out) const noexcept {
        kernels_.turn_back_to_double(view(), v.data(), out);
    }
    /// out = R v.
    void turn(const float* v, NodeField<S>& out) const noexcept {
        kernels_.turn_float(view(), v, out.data());
    }
    void turn(const double* v, NodeField<S>& out) const noexcept {
        kernels_.turn_double(view(), v, out.data());
    }

    /// The same between fields. @param out may be v
    void turn_back(const NodeField<S>& v, NodeField<S>& out) const noexcept {
        kernels_.turn_back(view(), v.data(), out.data());
    }
    void turn(const NodeField<S>& v, NodeField<S>& out) const noexcept {
        kernels_.turn(view(), v.data(), out.data());
    }

    /// x, y, z of all nodes, and what the kernels read and write behind them.
    [[nodiscard]] static constexpr std::size_t packed_size(std::size_t nodes) { return 3 * (nodes + 4) + 4; }

    /// Root mean square over the nodes, as last updated.
    [[nodiscard]] Real mean_angle_rad() const noexcept;
    [[nodiscard]] Mat rotation(std::size_t node) const noexcept;

  private:
    [[nodiscard]] NodeTurns<S> view() const noexcept;
    [[nodiscard]] std::size_t lane_of(std::size_t node) const noexcept;
    [[nodiscard]] std::size_t diagonal_of(std::size_t node) const noexcept;

    const RotationKernels<S>& kernels_;
    std::size_t count_ = 0, blocks_ = 0;
    AlignedArray<std::int32_t> tets_;
    AlignedArray<S> weights_;
    mutable AlignedArray<S> diagonals_;
    std::uint32_t next_share_ = 0;
    std::array<Real, 64> squared_angles_{};  ///< [shares] sum over the share's nodes
};

}  // namespace knead::core
