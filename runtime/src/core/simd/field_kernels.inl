// SPDX-License-Identifier: Apache-2.0
#include "core/simd/field_kernels.h"
#include "core/simd/vector.h"

namespace knead::core::KNEAD_SIMD {
namespace {

/// The unit of all loops: 16 numbers, whatever the width of the registers.
constexpr std::size_t kRun = 16;

template <class S>
S dot(std::size_t n, const S* a, const S* b) {
    using V = Vector<S, 16>;
    V total{};
    for (std::size_t i = 0; i < n; i += kRun)
        total += load<V>(a + i) * load<V>(b + i);
    return sum<16, S>(total);
}

template <class S>
S weighted_square(std::size_t n, const S* weight, const S* a) {
    using V = Vector<S, 16>;
    V total{};
    for (std::size_t i = 0; i < n; i += kRun)
        total += load<V>(weight + i) * load<V>(a + i) * load<V>(a + i);
    return sum<16, S>(total);
}

template <class S>
void multiply(std::size_t n, const S* a, S factor, const S* b, S* out) {
    using V = Vector<S, 16>;
    for (std::size_t i = 0; i < n; i += kRun)
        store(out + i, factor * load<V>(a + i) * load<V>(b + i));
}

template <class S>
void add_scaled(std::size_t n, const S* a, S factor, const S* b, S* out) {
    using V = Vector<S, 16>;
    for (std::size_t i = 0; i < n; i += kRun)
        store(out + i, load<V>(a + i) + factor * load<V>(b + i));
}

template <class S>
void scale(std::size_t n, S factor, S* a) {
    using V = Vector<S, 16>;
    for (std::size_t i = 0; i < n; i += kRun)
        store(a + i, factor * load<V>(a + i));
}

template <class S>
S advance(std::size_t n, S alpha, const S* p, const S* q, const S* weight, S* d, S* r) {
    using V = Vector<S, 16>;
    V total{};
    for (std::size_t i = 0; i < n; i += kRun) {
        store(d + i, load<V>(d + i) + alpha * load<V>(p + i));
        const V rest = load<V>(r + i) - alpha * load<V>(q + i);
        store(r + i, rest);
        total += rest * rest * load<V>(weight + i);
    }
    return sum<16, S>(total);
}

template <class S>
constexpr FieldKernels<S> field_kernels() {
    return {dot<S>, weighted_square<S>, multiply<S>, add_scaled<S>, scale<S>, advance<S>};
}

}  // namespace
}  // namespace knead::core::KNEAD_SIMD
