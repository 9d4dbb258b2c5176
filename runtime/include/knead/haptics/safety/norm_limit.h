// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "knead/haptics/export.h"
#include "knead/runtime/pose.h"

namespace knead {

/// Length of a vector: no overflow on the way, infinite or NaN if a component is.
[[nodiscard]] KNEAD_HAPTICS_API double norm(const Vec3& v) noexcept;

/// The vector, or the one of length `limit` in its direction if it is longer. A clip of each axis would bend
/// it.
///
/// The result's norm is never above the limit, rounding included: what is shortened ends a few units of the
/// last place below it. Not finite stays not finite. @param limit >= 0
[[nodiscard]] KNEAD_HAPTICS_API Vec3 limit_norm(const Vec3& v, double limit,
                                                bool* shortened = nullptr) noexcept;

}  // namespace knead
