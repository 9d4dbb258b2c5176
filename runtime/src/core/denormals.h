// SPDX-License-Identifier: Apache-2.0
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace knead::core {

/// While it lives, this thread computes by the usual rules whatever its caller has set (nearest rounding, no
/// traps: the same bits for everyone), but takes numbers too small to be normal for zero: quiet regions of an
/// object are full of them, and computing with them is slow. Restores what was before. No effect where it is
/// not known how.
class NoDenormals {
  public:
    NoDenormals() noexcept {
#if defined(__SSE2__)
        before_ = _mm_getcsr();
        constexpr unsigned kUsual = 0x1f80, kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
        _mm_setcsr(kUsual | kFlushToZero | kDenormalsAreZero);
#endif
    }
    ~NoDenormals() {
#if defined(__SSE2__)
        _mm_setcsr(before_);
#endif
    }
    NoDenormals(const NoDenormals&) = delete;
    NoDenormals& operator=(const NoDenormals&) = delete;

  private:
    unsigned before_ = 0;
};

}  // namespace knead::core
