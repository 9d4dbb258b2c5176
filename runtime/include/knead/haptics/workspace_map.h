// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "knead/haptics/export.h"
#include "knead/runtime/pose.h"

namespace knead {

/// From the device's frame to the scene's: position = offset + scale * rotation * device position.
/// Orientations turn along and are not scaled. Forces and torques come back through the inverse rotation;
/// their scale is a matter of its own (HapticConfig::force_scale).
struct WorkspaceMap {
    double scale = 1;                                 ///< scene metres per device metre, > 0
    std::array<double, 4> rotation_wxyz{1, 0, 0, 0};  ///< unit quaternion
    Vec3 offset_m{};                                  ///< scene position of the device's origin
};

[[nodiscard]] KNEAD_HAPTICS_API Pose to_scene(const WorkspaceMap& map, const Pose& device) noexcept;
/// A velocity: scaled and turned.
[[nodiscard]] KNEAD_HAPTICS_API Vec3 velocity_to_scene(const WorkspaceMap& map,
                                                       const Vec3& device_m_per_s) noexcept;
/// A force or torque: turned back only.
[[nodiscard]] KNEAD_HAPTICS_API Vec3 force_to_device(const WorkspaceMap& map, const Vec3& scene) noexcept;

}  // namespace knead
