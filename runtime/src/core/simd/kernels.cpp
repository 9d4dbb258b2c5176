// SPDX-License-Identifier: Apache-2.0
#include "core/simd/kernels.h"

#include <initializer_list>

namespace knead::core {

extern const Kernels kPortableKernels;
#if KNEAD_SIMD_X86
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;
#endif

bool has_simd_target(SimdTarget target) noexcept {
    switch (target) {
        case SimdTarget::portable:
            return true;
#if KNEAD_SIMD_X86
        case SimdTarget::avx2:
            return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                   __builtin_cpu_supports("f16c");
        case SimdTarget::avx512:
            return has_simd_target(SimdTarget::avx2) && __builtin_cpu_supports("avx512f") &&
                   __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl");
#endif
        default:
            return false;
    }
}

SimdTarget best_simd_target() noexcept {
    for (const SimdTarget target : {SimdTarget::avx512, SimdTarget::avx2}) {
        if (has_simd_target(target)) return target;
    }
    return SimdTarget::portable;
}

const Kernels& kernels(SimdTarget target) noexcept {
#if KNEAD_SIMD_X86
    if (target == SimdTarget::avx512) return kAvx512Kernels;
    if (target == SimdTarget::avx2) return kAvx2Kernels;
#endif
    (void)target;
    return kPortableKernels;
}

}  // namespace knead::core
