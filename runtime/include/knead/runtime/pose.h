// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace knead {

using Vec3 = std::array<double, 3>;

/// Position and orientation of a tool in the scene's right-handed frame.
struct Pose {
    Vec3 position_m{};
    std::array<double, 4> orientation_wxyz{1, 0, 0, 0};  ///< unit quaternion, tool frame to scene
};

}  // namespace knead
