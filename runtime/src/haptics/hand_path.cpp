// SPDX-License-Identifier: Apache-2.0
#include "haptics/hand_path.h"

#include <cmath>
#include <limits>

#include "haptics/quaternion.h"

namespace knead {

Vec3 rotation_vector(const QuaternionWxyz& q) noexcept {
    const double sine = std::sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double sign = q[0] < 0 ? -1 : 1;
    // Near no turn at all the quotient angle / sine is 2 to machine precision.
    const double per_sine = sine < 1e-9 ? 2 * sign : 2 * sign * std::atan2(sine, sign * q[0]) / sine;
    return {per_sine * q[1], per_sine * q[2], per_sine * q[3]};
}

QuaternionWxyz rotation_of(const Vec3& r) noexcept {
    const double angle = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    const double scale = angle < 1e-9 ? 0.5 : std::sin(angle / 2) / angle;
    return {std::cos(angle / 2), scale * r[0], scale * r[1], scale * r[2]};
}

HandWish wish_at(const std::vector<HandTarget>& path, std::size_t& at, double time_s) noexcept {
    if (path.empty()) return {};
    while (at + 1 < path.size() && path[at + 1].time_s <= time_s)
        ++at;
    HandWish wish{path[at].pose, {}, {}};
    if (time_s < path[at].time_s || at + 1 == path.size()) return wish;
    const HandTarget &from = path[at], &to = path[at + 1];
    const double seconds = to.time_s - from.time_s, since = time_s - from.time_s;
    const bool turns = to.pose.orientation_wxyz != from.pose.orientation_wxyz;
    const Vec3 turn =
        turns ? rotation_vector(multiply(to.pose.orientation_wxyz, inverse(from.pose.orientation_wxyz)))
              : Vec3{};
    Vec3 turned{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        wish.velocity_m_per_s[axis] = (to.pose.position_m[axis] - from.pose.position_m[axis]) / seconds;
        wish.pose.position_m[axis] += wish.velocity_m_per_s[axis] * since;
        wish.turn_rad_per_s[axis] = turn[axis] / seconds;
        turned[axis] = wish.turn_rad_per_s[axis] * since;
    }
    if (turns) wish.pose.orientation_wxyz = multiply(rotation_of(turned), from.pose.orientation_wxyz);
    return wish;
}

double next_change_s(const std::vector<HandTarget>& path, std::size_t at, double time_s) noexcept {
    for (std::size_t i = at; i < path.size(); ++i)
        if (path[i].time_s > time_s) return path[i].time_s;
    return std::numeric_limits<double>::infinity();
}

std::vector<HandTarget> press_path(const Pose& start, const Vec3& travel_m, double wait_s, double press_s) {
    Pose deep = start;
    for (std::size_t axis = 0; axis < 3; ++axis)
        deep.position_m[axis] += travel_m[axis];
    return {{wait_s, start}, {wait_s + press_s, deep}};
}

}  // namespace knead
