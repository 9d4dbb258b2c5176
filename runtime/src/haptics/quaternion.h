// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "knead/runtime/pose.h"

namespace knead {

using QuaternionWxyz = std::array<double, 4>;

inline double length(const QuaternionWxyz& q) noexcept {
    return std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}

/// As far as what a device or an application gives can be: to a thousandth. False if it is not finite.
inline bool is_unit(const QuaternionWxyz& q) noexcept {
    constexpr double kTolerance = 1e-3;
    return std::abs(length(q) - 1) <= kTolerance;
}

/// a then b read from the right: rotates by b first.
inline QuaternionWxyz multiply(const QuaternionWxyz& a, const QuaternionWxyz& b) noexcept {
    return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

inline QuaternionWxyz inverse(const QuaternionWxyz& unit) noexcept {
    return {unit[0], -unit[1], -unit[2], -unit[3]};
}

inline Vec3 rotate(const QuaternionWxyz& unit, const Vec3& v) noexcept {
    const QuaternionWxyz result = multiply(multiply(unit, {0, v[0], v[1], v[2]}), inverse(unit));
    return {result[1], result[2], result[3]};
}

}  // namespace knead
