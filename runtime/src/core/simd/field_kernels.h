// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace knead::core {

/// Arithmetic on fields (four numbers a node, the fourth zero). `n` counts numbers, a multiple of 16;
/// pointers are aligned to 64 bytes. Sums are made in a fixed order.
template <class S>
struct FieldKernels {
    S (*dot)(std::size_t n, const S* a, const S* b);
    /// @return sum of weight * a * a
    S (*weighted_square)(std::size_t n, const S* weight, const S* a);
    /// out = factor * a * b
    void (*multiply)(std::size_t n, const S* a, S factor, const S* b, S* out);
    /// out = a + factor * b
    void (*add_scaled)(std::size_t n, const S* a, S factor, const S* b, S* out);
    void (*scale)(std::size_t n, S factor, S* a);
    /// d += alpha p and r -= alpha q  @return sum of r * r * weight
    S (*advance)(std::size_t n, S alpha, const S* p, const S* q, const S* weight, S* d, S* r);
};

}  // namespace knead::core
