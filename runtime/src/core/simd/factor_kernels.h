// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace knead::core {

/// The inner loops of SupernodalFactor, one set per instruction set.
struct FactorKernels {
    /// y -= A x for a column-major panel.
    void (*subtract_product)(std::size_t rows, std::size_t columns, const float* a, const float* x, float* y);
};

}  // namespace knead::core
