// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/simd/factor_kernels.h"

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
};

/// The fastest that this processor and this build have.
SimdTarget best_simd_target() noexcept;

/// Whether this processor and this build have it.
bool has_simd_target(SimdTarget target) noexcept;

/// @pre has_simd_target(target)
const Kernels& kernels(SimdTarget target) noexcept;

}  // namespace knead::core
