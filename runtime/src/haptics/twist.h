// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "haptics/quaternion.h"
#include "knead/runtime/pose.h"

namespace knead {

using Vec6 = Eigen::Matrix<double, 6, 1>;

/// The shorter way round. @param q unit, or nearly
inline Eigen::Vector3d rotation_vector(QuaternionWxyz q) noexcept {
    if (q[0] < 0) q = {-q[0], -q[1], -q[2], -q[3]};
    const Eigen::Vector3d v(q[1], q[2], q[3]);
    const double sine = v.norm();
    const double small = 1e-9;
    if (sine < small) return 2 * v;
    return (2 * std::atan2(sine, q[0]) / sine) * v;
}

inline QuaternionWxyz quaternion(const Eigen::Vector3d& rotation_vector) noexcept {
    const double half = 0.5 * rotation_vector.norm();
    const double small = 1e-9;
    const double share = half < small ? 0.5 : 0.5 * std::sin(half) / half;
    return {std::cos(half), share * rotation_vector[0], share * rotation_vector[1],
            share * rotation_vector[2]};
}

inline QuaternionWxyz normalised(const QuaternionWxyz& q) noexcept {
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    return {q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm};
}

/// Way from one pose to another: metres, then the rotation vector, both in the scene's frame.
inline Vec6 twist(const Pose& from, const Pose& to) noexcept {
    Vec6 d;
    for (int axis = 0; axis < 3; ++axis)
        d[axis] = to.position_m[axis] - from.position_m[axis];
    d.tail<3>() = rotation_vector(multiply(to.orientation_wxyz, inverse(from.orientation_wxyz)));
    return d;
}

/// The pose `d` away from `from`.
inline Pose moved(const Pose& from, const Vec6& d) noexcept {
    Pose to;
    for (int axis = 0; axis < 3; ++axis)
        to.position_m[axis] = from.position_m[axis] + d[axis];
    to.orientation_wxyz = normalised(multiply(quaternion(d.tail<3>()), from.orientation_wxyz));
    return to;
}

}  // namespace knead
