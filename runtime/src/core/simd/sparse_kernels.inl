// SPDX-License-Identifier: Apache-2.0
#include "core/simd/sparse_kernels.h"
#include "core/simd/vector.h"

namespace knead::core::KNEAD_SIMD {
namespace {

template <class S>
void multiply_blocks(const BlockRows<S>& a, const S* v, S* out) {
    using V = Vector<S, 4>;
    for (std::size_t row = 0; row < a.rows; ++row) {
        // Three sums, because each waits for itself.
        V x{}, y{}, z{};
        for (std::uint32_t k = a.begin[row]; k < a.begin[row + 1]; ++k) {
            const S* const in = v + a.columns[k];
            const S* const block = a.blocks + std::size_t{12} * k;
            x += load<V>(block) * in[0];
            y += load<V>(block + 4) * in[1];
            z += load<V>(block + 8) * in[2];
        }
        store(out + 4 * row, x + y + z);
    }
}

template <class S>
constexpr SparseKernels<S> sparse_kernels() {
    return {multiply_blocks<S>};
}

}  // namespace
}  // namespace knead::core::KNEAD_SIMD
