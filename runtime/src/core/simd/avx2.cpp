// SPDX-License-Identifier: Apache-2.0
#define KNEAD_SIMD avx2
#define KNEAD_SIMD_BYTES 32
#include "core/simd/element_kernels.inl"
#include "core/simd/factor_kernels.inl"
#include "core/simd/field_kernels.inl"
#include "core/simd/kernels.h"
#include "core/simd/rotation_kernels.inl"
#include "core/simd/sparse_kernels.inl"

namespace knead::core {

extern const Kernels kAvx2Kernels;
const Kernels kAvx2Kernels = {avx2::factor_kernels(),
                              avx2::element_kernels<float, float>(),
                              avx2::element_kernels<double, float>(),
                              avx2::element_kernels<double, double>(),
                              avx2::field_kernels<float>(),
                              avx2::field_kernels<double>(),
                              avx2::sparse_kernels<float>(),
                              avx2::sparse_kernels<double>(),
                              avx2::rotation_kernels<float>(),
                              avx2::rotation_kernels<double>()};

}  // namespace knead::core
