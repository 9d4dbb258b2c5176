// SPDX-License-Identifier: Apache-2.0
#define KNEAD_SIMD avx2
#define KNEAD_SIMD_BYTES 32
#include "core/simd/factor_kernels.inl"
#include "core/simd/kernels.h"

namespace knead::core {

extern const Kernels kAvx2Kernels;
const Kernels kAvx2Kernels = {avx2::factor_kernels()};

}  // namespace knead::core
