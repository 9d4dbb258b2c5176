// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "knead/haptics/export.h"
#include "knead/runtime/pose.h"

namespace knead {

/// Bounds how fast a force changes: the norm of the difference, in all directions alike, up or down.
class KNEAD_HAPTICS_API SlewLimit {
  public:
    /// @param most_per_s force per second, > 0
    explicit SlewLimit(double most_per_s) noexcept : most_per_s_(most_per_s) {}

    /// @param wanted finite  @param dt_s since the last call, >= 0
    /// @param status gets kHapticSlewLimited if it acts
    /// @return on the straight way from the last force to `wanted`, at most most_per_s dt_s from the last
    /// force
    [[nodiscard]] Vec3 apply(const Vec3& wanted, double dt_s, std::uint32_t& status) noexcept;

    /// The force that later stages made of it: the next change starts there.
    void follow(const Vec3& written) noexcept { last_ = written; }

  private:
    double most_per_s_;
    Vec3 last_{};
};

}  // namespace knead
