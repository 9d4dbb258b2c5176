// SPDX-License-Identifier: Apache-2.0
// Included by the *_kernels.inl files only: compiled once per instruction set, in a namespace of its own.
#pragma once

#include <cstddef>
#include <cstdint>

namespace knead::core {

/// W numbers that are computed with at once (vector extension of GCC and Clang: operators, comparisons and
/// `mask ? a : b` work lane by lane). Wider than the machine's registers is allowed, only slower.
template <class S, int W>
struct VectorOf {
    using type [[gnu::vector_size(W * sizeof(S))]] = S;
};
template <class S, int W>
using Vector = typename VectorOf<S, W>::type;

}  // namespace knead::core
