// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace knead::core {

/// A sparse matrix of 3 x 3 blocks as the kernels read it, in compressed rows. A block is stored by columns of
/// four numbers, the fourth zero: 12 numbers, aligned to 16 bytes.
template <class S>
struct BlockRows {
    std::size_t rows = 0;
    const std::uint32_t* begin = nullptr;    ///< [rows + 1]
    const std::uint32_t* columns = nullptr;  ///< [begin[rows]] four times the index of the column
    const S* blocks = nullptr;               ///< [begin[rows]][12]
};

template <class S>
struct SparseKernels {
    /// out = A v. Fields have four numbers a node; out is not v.
    void (*multiply)(const BlockRows<S>& a, const S* v, S* out);
};

}  // namespace knead::core
