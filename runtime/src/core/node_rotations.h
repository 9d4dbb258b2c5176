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
    explicit NodeRotations(const Model& model);

    void reset() noexcept;

    /// Takes one of `shares` shares (at most 64) of the nodes anew, the next one with each call.
    void update(const Elements<S>& elements, std::uint32_t shares) noexcept;

    /// out = R^T v: into the rest state's frame. Packed x, y, z.
    template <class T>
    void turn_back(const NodeField<S>& v, T* out) const noexcept;
    /// out = R v.
    template <class T>
    void turn(const T* v, NodeField<S>& out) const noexcept;

    /// The same between fields. @param out may be v
    void turn_back(const NodeField<S>& v, NodeField<S>& out) const noexcept;
    void turn(const NodeField<S>& v, NodeField<S>& out) const noexcept;

    /// Root mean square over the nodes, as last updated.
    [[nodiscard]] Real mean_angle_rad() const noexcept;
    [[nodiscard]] Mat rotation(std::size_t node) const noexcept;

  private:
    struct Neighbour {
        std::uint32_t element = 0;
        float weight = 0;
    };
    /// @return its squared angle
    Real update_node(const Elements<S>& elements, std::size_t node) noexcept;

    std::vector<std::uint32_t> begin_;  ///< [free nodes + 1]
    std::vector<Neighbour> neighbours_;
    std::vector<std::array<S, 9>> matrices_;  ///< [free nodes] row-major
    std::uint32_t next_share_ = 0;
    std::array<Real, 64> squared_angles_{};  ///< [shares] sum over the share's nodes
};

template <class S>
template <class T>
void NodeRotations<S>::turn_back(const NodeField<S>& v, T* out) const noexcept {
    const S* in = v.data();
    for (const std::array<S, 9>& r : matrices_) {
        const S x = in[0], y = in[1], z = in[2];
        out[0] = static_cast<T>(r[0] * x + r[3] * y + r[6] * z);
        out[1] = static_cast<T>(r[1] * x + r[4] * y + r[7] * z);
        out[2] = static_cast<T>(r[2] * x + r[5] * y + r[8] * z);
        in += 4;
        out += 3;
    }
}

template <class S>
template <class T>
void NodeRotations<S>::turn(const T* v, NodeField<S>& out) const noexcept {
    S* to = out.data();
    for (const std::array<S, 9>& r : matrices_) {
        const S x = static_cast<S>(v[0]), y = static_cast<S>(v[1]), z = static_cast<S>(v[2]);
        to[0] = r[0] * x + r[1] * y + r[2] * z;
        to[1] = r[3] * x + r[4] * y + r[5] * z;
        to[2] = r[6] * x + r[7] * y + r[8] * z;
        to += 4;
        v += 3;
    }
}

}  // namespace knead::core
