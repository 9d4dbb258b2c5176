// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace knead::core {

constexpr std::size_t kTetsInStrip = 3;

/// The linearised tetrahedra as the kernels read them: in blocks of `width` strips, each number of a block
/// side by side.
///
/// A strip is a path of three tetrahedra, each sharing a face with the next (tet_strips.h): six nodes are
/// read and written for them instead of twelve. Tetrahedron k of a strip has its nodes 0, k + 1, k + 2, k
/// + 3. Lane l of block b is strip l * blocks + b, so that neighbours in the list, which share nodes, are not
/// in the same block. Tetrahedra that are missing have zero gradients and zero stiffness, nodes that are
/// missing are the one behind the last. V: the numbers of the vectors that are multiplied, float or double.
template <class V>
struct StiffnessArrays {
    std::size_t blocks = 0;
    const std::int32_t* nodes = nullptr;  ///< [blocks][kTetsInStrip + 3][width] four times the node's index
    const V* lame_volume = nullptr;       ///< [blocks][kTetsInStrip][2][width] mu, lambda times the volume
    V* rotations = nullptr;               ///< [blocks][kTetsInStrip][4][width] w, x, y, z
    V* gradients = nullptr;               ///< [blocks][kTetsInStrip][9][width] rows turned by the rotation
};

/// The same with what it is made of. S: the numbers of the state, at least as wide as V.
template <class S, class V>
struct ElementArrays {
    StiffnessArrays<V> linearised;  ///< written
    /// [blocks][kTetsInStrip][9][width] row j: gradient of node k + j + 1's shape function
    const S* rest_inverse = nullptr;
    S* rotations = nullptr;  ///< as those of `linearised`, and the same if S is V: state
};

/// Finds the rotation of one deformation gradient from scratch (rotation.h), for lanes whose warm start
/// failed.
/// @param grad_u [9] row-major, of displacements: the deformation gradient less the identity
/// @param q [4] w, x, y, z; left alone if grad_u is not finite
template <class S>
using RotationFallback = void (*)(const S* grad_u, S* q);

/// The passes over the tetrahedra. Fields have four numbers a node, the fourth zero, and a node of zeros at
/// the end. All pointers are aligned to 64 bytes.
template <class S, class V>
struct ElementKernels {
    std::size_t width;
    /// Updates rotations and gradients; forces += scale * elastic forces (N).
    /// @param u displacements from rest, m
    /// @return whether a tetrahedron is inside out
    bool (*linearise)(const ElementArrays<S, V>& elements, S scale, const S* u, S* forces,
                      RotationFallback<S> fallback);
    /// out += scale * K(R) u at the state that was linearised last
    void (*apply_stiffness)(const StiffnessArrays<V>& elements, V scale, const V* u, V* out);
};

}  // namespace knead::core
