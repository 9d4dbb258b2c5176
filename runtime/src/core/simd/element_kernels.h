// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace knead::core {

/// The tetrahedra as the kernels read them: in blocks of `width`, each number of a block side by side.
///
/// Lane l of block b is tetrahedron l * blocks + b, so that neighbours in the list, which share nodes, are
/// not in the same block. Lanes without a tetrahedron have zero stiffness and the node behind the last one.
/// S is float or double.
template <class S>
struct ElementArrays {
    std::size_t blocks = 0;
    const std::int32_t* nodes = nullptr;  ///< [blocks][4][width] four times the node's index
    const S* rest_inverse = nullptr;  ///< [blocks][9][width] row k: gradient of node k + 1's shape function
    const S* lame_volume = nullptr;   ///< [blocks][2][width] mu, lambda times the volume
    S* rotations = nullptr;           ///< [blocks][4][width] w, x, y, z: state
    S* gradients = nullptr;           ///< [blocks][9][width] rows turned by the rotation: state
};

/// Finds the rotation of one deformation gradient from scratch (rotation.h), for lanes whose warm start
/// failed.
/// @param f [9] row-major  @param q [4] w, x, y, z; left alone if f is not finite
template <class S>
using RotationFallback = void (*)(const S* f, S* q);

/// The passes over the tetrahedra. Fields have four numbers a node, the fourth zero, and a node of zeros at
/// the end. All pointers are aligned to 64 bytes.
template <class S>
struct ElementKernels {
    std::size_t width;
    /// Updates rotations and gradients; forces += scale * elastic forces (N).
    /// @param u displacements from rest, m
    void (*linearise)(const ElementArrays<S>& elements, S scale, const S* u, S* forces,
                      RotationFallback<S> fallback);
    /// out += scale * K(R) u at the state that was linearised last
    void (*apply_stiffness)(const ElementArrays<S>& elements, S scale, const S* u, S* out);
};

}  // namespace knead::core
