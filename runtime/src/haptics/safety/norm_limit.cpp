// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/safety/norm_limit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knead {
namespace {

/// More than the rounding of one scaling and of any usual way to measure the result.
constexpr double kMargin = 8 * std::numeric_limits<double>::epsilon();

/// A limit below it is zero: products of so small numbers do not round as others do.
constexpr double kNothing = 1e-290;

double largest(const Vec3& v) noexcept {
    return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

/// Of v / scale: squares neither overflow nor vanish.
double scaled_norm(const Vec3& v, double scale) noexcept {
    const double x = v[0] / scale;
    const double y = v[1] / scale;
    const double z = v[2] / scale;
    return std::sqrt(x * x + y * y + z * z);
}

bool finite(const Vec3& v) noexcept {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

}  // namespace

double norm(const Vec3& v) noexcept {
    if (!finite(v)) return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]);
    const double scale = largest(v);
    return scale > 0 ? scale * scaled_norm(v, scale) : 0;
}

Vec3 limit_norm(const Vec3& v, double limit, bool* shortened) noexcept {
    if (shortened) *shortened = false;
    if (!finite(v)) return v;
    const double scale = largest(v);
    if (!(scale > 0)) return v;
    if (limit < kNothing) {
        if (shortened) *shortened = true;
        return {};
    }
    const double length = scaled_norm(v, scale);
    const double safe = limit * (1 - kMargin);
    if (scale * length <= safe) return v;
    // The margin alone is nobody's business.
    if (shortened) *shortened = scale * length > limit;
    const double factor = safe / length;
    return {v[0] / scale * factor, v[1] / scale * factor, v[2] / scale * factor};
}

}  // namespace knead
