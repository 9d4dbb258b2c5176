// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/safety/slew_limit.h"

#include "knead/haptics/safety/norm_limit.h"
#include "knead/haptics/status.h"

namespace knead {

Vec3 SlewLimit::apply(const Vec3& wanted, double dt_s, std::uint32_t& status) noexcept {
    bool shortened = false;
    const Vec3 change = limit_norm({wanted[0] - last_[0], wanted[1] - last_[1], wanted[2] - last_[2]},
                                   most_per_s_ * dt_s, &shortened);
    if (!shortened) {
        last_ = wanted;
        return last_;
    }
    status |= kHapticSlewLimited;
    for (std::size_t axis = 0; axis < 3; ++axis)
        last_[axis] += change[axis];
    return last_;
}

}  // namespace knead
