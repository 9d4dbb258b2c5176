// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace knead::core {

/// Tetrahedra whose rotations a node's is the mean of: enough for a preconditioner, few enough to visit
/// often.
constexpr std::size_t kTetsOfNode = 6;

/// A rotation for every node as the kernels read it: in groups of `width` / 4 nodes, four numbers of each
/// side by side.
///
/// A matrix is stored by its diagonals (r00, r11, r22, 0), (r01, r12, r20, 0) and (r02, r10, r21, 0): so
/// R v and R^T v are both three products and two shuffles. Nodes that are missing in the last group are zero.
/// To average, nodes are taken in blocks of `width`, four groups: lane 4 i + j of block b is node
/// width * b + width / 4 * j + i. Pointers are aligned to 64 bytes. S is float or double.
template <class S>
struct NodeTurns {
    std::size_t groups = 0;
    S* diagonals = nullptr;  ///< [groups, up to a multiple of 4][3][width]
    /// [blocks][kTetsOfNode][width] where the w of a tetrahedron's rotation stands
    const std::int32_t* tets = nullptr;
    /// [blocks][kTetsOfNode][width] in units of the first, which is 1; of missing nodes all are 0
    const S* weights = nullptr;
};

template <class S>
struct RotationKernels {
    std::size_t width;  ///< of a block
    /// Takes the rotations of one block anew: means of quaternions, on the side of the first.
    /// @param rotations as ElementArrays has them; `stride` from w to x, to y and to z
    /// @return sum over the nodes of the squared angle, good enough up to a right angle
    S (*average)(const NodeTurns<S>& turns, std::size_t block, const S* rotations, std::size_t stride);
    /// out = R^T v of all nodes, missing ones too. @param out may be v
    void (*turn_back)(const NodeTurns<S>& turns, const S* v, S* out);
    /// out = R v
    void (*turn)(const NodeTurns<S>& turns, const S* v, S* out);
    /// The same from fields to x, y, z one after the other, or back. Of missing nodes and one more the
    /// numbers are overwritten (turn_back), or read (turn).
    void (*turn_back_to_float)(const NodeTurns<S>& turns, const S* v, float* out);
    void (*turn_back_to_double)(const NodeTurns<S>& turns, const S* v, double* out);
    void (*turn_float)(const NodeTurns<S>& turns, const float* v, S* out);
    void (*turn_double)(const NodeTurns<S>& turns, const double* v, S* out);
};

}  // namespace knead::core
