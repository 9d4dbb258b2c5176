// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "overlap/prepared_tet.h"

namespace knead::tools {

/// [axis][face] sum of the absolute values of the products whose difference is the face's normal.
inline std::array<std::array<double, 4>, 3> normal_scale_of(const Corners& corners) {
    std::array<std::array<double, 4>, 3> scale;
    for (int face = 0; face < 4; ++face) {
        const auto [a, b, c] = kFaceOppositeTo[face];
        Point u;
        Point v;
        for (int axis = 0; axis < 3; ++axis) {
            u[axis] = std::abs(corners[b][axis] - corners[a][axis]);
            v[axis] = std::abs(corners[c][axis] - corners[a][axis]);
        }
        for (int axis = 0; axis < 3; ++axis) {
            const int j = (axis + 1) % 3;
            const int k = (axis + 2) % 3;
            scale[axis][face] = u[j] * v[k] + u[k] * v[j];
        }
    }
    return scale;
}

/// Bound of the rounding error of plane_values(), per face, for corners at most `reach` away from the face's
/// origin along each axis. A value is a sum of six products of three coordinate differences: each factor is
/// rounded once (3), two products (2), and three sums are passed at most (3): 8 roundings of half an epsilon.
/// Two more pay for the rounding of the bound itself.
template <class Real>
std::array<double, 4> plane_value_errors(const std::array<std::array<double, 4>, 3>& normal_scale,
                                         const Point& reach) {
    constexpr double kRoundings = 10 * 0.5 * static_cast<double>(std::numeric_limits<Real>::epsilon());
    std::array<double, 4> errors;
    for (int face = 0; face < 4; ++face)
        errors[face] = kRoundings * (normal_scale[0][face] * reach[0] + normal_scale[1][face] * reach[1] +
                                     normal_scale[2][face] * reach[2]);
    return errors;
}

}  // namespace knead::tools
