// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "knead/haptics/simulated_operator.h"

namespace knead {

/// Where a hand wants to be and how fast it wants to move there.
struct HandWish {
    Pose pose;
    Vec3 velocity_m_per_s{};
    Vec3 turn_rad_per_s{};
};

/// The targets in force at a moment. @param at index of the last target that is over, moved on as needed;
/// time must not go back between calls with the same `at`
[[nodiscard]] HandWish wish_at(const std::vector<HandTarget>& path, std::size_t& at, double time_s) noexcept;

/// The next moment after `time_s` at which the wish changes its course; infinity: never.
[[nodiscard]] double next_change_s(const std::vector<HandTarget>& path, std::size_t at,
                                   double time_s) noexcept;

/// The rotation vector of a unit quaternion, the shorter way round, radians.
[[nodiscard]] Vec3 rotation_vector(const std::array<double, 4>& unit_wxyz) noexcept;
/// The unit quaternion of a rotation vector.
[[nodiscard]] std::array<double, 4> rotation_of(const Vec3& rotation_vector_rad) noexcept;

}  // namespace knead
