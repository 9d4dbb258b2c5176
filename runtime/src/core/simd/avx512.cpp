// SPDX-License-Identifier: Apache-2.0
#define KNEAD_SIMD avx512
#define KNEAD_SIMD_BYTES 64
#include "core/simd/element_kernels.inl"
#include "core/simd/factor_kernels.inl"
#include "core/simd/field_kernels.inl"
#include "core/simd/kernels.h"
#include "core/simd/rotation_kernels.inl"
#include "core/simd/sparse_kernels.inl"

namespace knead::core {

extern const Kernels kAvx512Kernels;
const Kernels kAvx512Kernels = {avx512::factor_kernels(),
                                avx512::element_kernels<float, float>(),
                                avx512::element_kernels<double, float>(),
                                avx512::element_kernels<double, double>(),
                                avx512::field_kernels<float>(),
                                avx512::field_kernels<double>(),
                                avx512::sparse_kernels<float>(),
                                avx512::sparse_kernels<double>(),
                                avx512::rotation_kernels<float>(),
                                avx512::rotation_kernels<double>()};

}  // namespace knead::core
