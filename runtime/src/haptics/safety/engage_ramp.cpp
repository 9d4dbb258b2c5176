// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/safety/engage_ramp.h"

#include <algorithm>

#include "knead/haptics/safety/norm_limit.h"
#include "knead/haptics/status.h"

namespace knead {

void EngageRamp::rearm(double ceiling) noexcept {
    ceiling_ = std::min(ceiling_, ceiling);
}

Vec3 EngageRamp::apply(const Vec3& force, double dt_s, std::uint32_t& status) noexcept {
    if (!(ceiling_ < full_)) return force;
    status |= kHapticRamping;
    const Vec3 allowed = limit_norm(force, ceiling_);
    ceiling_ = std::min(full_, ceiling_ + rise_per_s_ * dt_s);
    return allowed;
}

}  // namespace knead
