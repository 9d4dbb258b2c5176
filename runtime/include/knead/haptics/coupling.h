// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "knead/haptics/export.h"
#include "knead/runtime/pose.h"

namespace knead {

/// The virtual coupling: a spring and a damper between the hand and the tool in the scene (the proxy), one
/// pair for translations and one for rotations. All numbers are of the scene's side: on the device a spring
/// is HapticConfig::force_scale * WorkspaceMap::scale times as stiff. It should be no stiffer than the device
/// renders.
///
/// Source: Colgate, Stanley, Brown: Issues in the haptic display of tool use. 1995; design page haptics,
/// section 1.
struct CouplingConfig {
    double stiffness_n_per_m = 400;  ///< > 0
    double damping_n_s_per_m = 0.5;  ///< >= 0
    double tool_mass_kg = 0.05;      ///< of the proxy, > 0
    /// Zero: three degrees of freedom. The tool keeps the hand's orientation and no torque is given.
    double rotation_stiffness_nm_per_rad = 0;
    double rotation_damping_nm_s_per_rad = 0;  ///< >= 0
    double tool_inertia_kg_m2 = 2e-5;  ///< of the proxy about its origin, the same about every axis, > 0
};

/// A force and a torque about the tool's origin.
struct Wrench {
    Vec3 force_n{};
    Vec3 torque_nm{};
};

}  // namespace knead
