// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "knead/haptics/export.h"
#include "knead/runtime/pose.h"

namespace knead {

/// A ceiling of the norm that rises at a steady rate after engaging: nothing starts at full force.
class KNEAD_HAPTICS_API EngageRamp {
  public:
    /// Armed: the ceiling is at zero. @param full where the ceiling ends, >= 0  @param rise_per_s > 0
    EngageRamp(double full, double rise_per_s) noexcept : full_(full), rise_per_s_(rise_per_s) {}

    /// The ceiling falls to `ceiling`, if it is not below already.
    void rearm(double ceiling = 0) noexcept;

    /// Shortens to the ceiling, then lets it rise.
    /// @param dt_s until the next call, >= 0  @param status gets kHapticRamping while the ceiling is below
    /// full
    [[nodiscard]] Vec3 apply(const Vec3& force, double dt_s, std::uint32_t& status) noexcept;

    [[nodiscard]] double ceiling() const noexcept { return ceiling_; }

  private:
    double full_;
    double rise_per_s_;
    double ceiling_ = 0;
};

}  // namespace knead
