// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/workspace_map.h"

#include "haptics/quaternion.h"

namespace knead {

Pose to_scene(const WorkspaceMap& map, const Pose& device) noexcept {
    Pose scene;
    const Vec3 moved = velocity_to_scene(map, device.position_m);
    for (std::size_t axis = 0; axis < 3; ++axis)
        scene.position_m[axis] = map.offset_m[axis] + moved[axis];
    scene.orientation_wxyz = multiply(map.rotation_wxyz, device.orientation_wxyz);
    return scene;
}

Vec3 velocity_to_scene(const WorkspaceMap& map, const Vec3& device_m_per_s) noexcept {
    Vec3 scene = rotate(map.rotation_wxyz, device_m_per_s);
    for (double& component : scene)
        component *= map.scale;
    return scene;
}

Vec3 force_to_device(const WorkspaceMap& map, const Vec3& scene) noexcept {
    return rotate(inverse(map.rotation_wxyz), scene);
}

}  // namespace knead
