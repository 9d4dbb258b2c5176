// SPDX-License-Identifier: Apache-2.0
#define KNEAD_SIMD portable
#define KNEAD_SIMD_BYTES 16
#include "core/simd/element_kernels.inl"
#include "core/simd/factor_kernels.inl"
#include "core/simd/field_kernels.inl"
#include "core/simd/kernels.h"
#include "core/simd/rotation_kernels.inl"
#include "core/simd/sparse_kernels.inl"

namespace knead::core {

extern const Kernels kPortableKernels;
const Kernels kPortableKernels = {portable::factor_kernels(),
                                  portable::element_kernels<float, float>(),
                                  portable::element_kernels<double, float>(),
                                  portable::element_kernels<double, double>(),
                                  portable::field_kernels<float>(),
                                  portable::field_kernels<double>(),
                                  portable::sparse_kernels<float>(),
                                  portable::sparse_kernels<double>(),
                                  portable::rotation_kernels<float>(),
                                  portable::rotation_kernels<double>()};

}  // namespace knead::core
