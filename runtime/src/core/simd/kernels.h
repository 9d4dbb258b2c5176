// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/simd/element_kernels.h"
#include "core/simd/factor_kernels.h"
#include "core/simd/field_kernels.h"
#include "core/simd/rotation_kernels.h"
#include "core/simd/sparse_kernels.h"

namespace knead::core {

/// Instruction sets that the kernels are compiled for, in ascending order of speed.
enum class SimdTarget : std::uint8_t {
    portable,  ///< what the compiler makes for the machine it was told; 16-byte vectors
    avx2,      ///< with FMA and F16C
    avx512,    ///< F, BW, DQ, VL
};

/// All functions of the core that are compiled once per instruction set.
struct Kernels {
    FactorKernels factor;
    ElementKernels<float, float> element_float;
    ElementKernels<double, float> element_mixed;
    ElementKernels<double, double> element_double;
    FieldKernels<float> field_float;
    FieldKernels<double> field_double;
    SparseKernels<float> sparse_float;
    SparseKernels<double> sparse_double;
    RotationKernels<float> rotation_float;
    RotationKernels<double> rotation_double;

    template <class S, class V>
    [[nodiscard]] const ElementKernels<S, V>& element() const noexcept {
        if constexpr (sizeof(S) == sizeof(float))
            return element_float;
        else if constexpr (sizeof(V) == sizeof(float))
            return element_mixed;
        else
            return element_double;
    }
    template <class S>
    [[nodiscard]] const FieldKernels<S>& field() const noexcept {
        if constexpr (sizeof(S) == sizeof(float))
            return field_float;
        else
            return field_double;
    }
    template <class S>
    [[nodiscard]] const SparseKernels<S>& sparse() const noexcept {
        if constexpr (sizeof(S) == sizeof(float))
            return sparse_float;
        else
            return sparse_double;
    }
    template <class S>
    [[nodiscard]] const RotationKernels<S>& rotation() const noexcept {
        if constexpr (sizeof(S) == sizeof(float))
            return rotation_float;
        else
            return rotation_double;
    }
};

/// The fastest that this processor and this build have.
SimdTarget best_simd_target() noexcept;

/// Whether this processor and this build have it.
bool has_simd_target(SimdTarget target) noexcept;

/// @pre has_simd_target(target)
const Kernels& kernels(SimdTarget target) noexcept;

}  // namespace knead::core
