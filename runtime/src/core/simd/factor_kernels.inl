// SPDX-License-Identifier: Apache-2.0
#include "core/simd/factor_kernels.h"
#include "core/simd/vector.h"

namespace knead::core::KNEAD_SIMD {
namespace {

void subtract_product(std::size_t rows, std::size_t columns, const float* a, const float* x, float* y) {
    for (std::size_t c = 0; c < columns; ++c) {
        for (std::size_t r = 0; r < rows; ++r)
            y[r] -= a[c * rows + r] * x[c];
    }
}

constexpr FactorKernels factor_kernels() {
    return {subtract_product};
}

}  // namespace
}  // namespace knead::core::KNEAD_SIMD
