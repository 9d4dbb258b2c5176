// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace knead::core {

/// A sparse matrix of 3 x 3 blocks as the kernels read it: in groups of rows of about the same length, which
/// are computed together, block after block; shorter rows are filled up with zeros.
///
/// A block is stored by columns of four numbers, the fourth zero; column c of the blocks of a group stands
/// side by side. Pointers are aligned to 64 bytes.
template <class S>
struct BlockGroups {
    std::size_t groups = 0;
    const std::uint32_t* begin = nullptr;   ///< [groups + 1] first block of each group, in blocks of one row
    const std::int32_t* rows = nullptr;     ///< [groups][at_once] four times the row
    const std::int32_t* columns = nullptr;  ///< [begin[groups]][at_once] four times the column
    const S* blocks = nullptr;              ///< [begin[groups]][3][at_once][4]
};

template <class S>
struct SparseKernels {
    std::size_t at_once;  ///< rows of a group
    /// out = A v. Fields have four numbers a node; out is not v.
    void (*multiply)(const BlockGroups<S>& a, const S* v, S* out);
};

}  // namespace knead::core
