// SPDX-License-Identifier: Apache-2.0
#include "core/simd/sparse_kernels.h"
#include "core/simd/vector.h"

namespace knead::core::KNEAD_SIMD {
namespace {

template <class S>
void multiply_blocks(const BlockGroups<S>& a, const S* v, S* out) {
    constexpr int W = kLanes<S>;
    constexpr std::size_t at_once = W / 4;
    using V = Vector<S, W>;
    for (std::size_t group = 0; group < a.groups; ++group) {
        // Three sums, because each waits for itself.
        V x{}, y{}, z{};
        for (std::uint32_t k = a.begin[group]; k < a.begin[group + 1]; ++k) {
            const V in = load_groups<S, W, 1>(v, a.columns + at_once * k);
            const S* const block = a.blocks + std::size_t{3} * W * k;
            x += load<V>(block) * shuffle_groups<0, 0, 0, 0, W>(in, in);
            y += load<V>(block + W) * shuffle_groups<1, 1, 1, 1, W>(in, in);
            z += load<V>(block + 2 * W) * shuffle_groups<2, 2, 2, 2, W>(in, in);
        }
        store_groups<S, W>(x + y + z, a.rows + at_once * group, out);
    }
}

template <class S>
constexpr SparseKernels<S> sparse_kernels() {
    return {kLanes<S> / 4, multiply_blocks<S>};
}

}  // namespace
}  // namespace knead::core::KNEAD_SIMD
