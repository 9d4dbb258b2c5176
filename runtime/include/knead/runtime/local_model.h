// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "knead/runtime/pose.h"

namespace knead {

/// [6][6], row-major: three translations, then three rotations about the tool's origin, scene frame.
using Mat6 = std::array<double, 36>;

/// What an object answers near where one tool stands: a linear view of one step's end, for whoever renders
/// forces faster than the object is simulated.
///
/// The force on the hand at a small twist d away, moving with w and accelerating with a, is
/// load - stiffness d - damping w - mass a, where load = (force_n, torque_nm). All three matrices are
/// symmetric and positive semidefinite. Rows and columns of the rotations are zero unless the simulation was
/// asked for torques.
struct LocalModel {
    Pose origin;       ///< of the tool, at the end of the step
    Vec3 force_n{};    ///< on the hand there, with the tool at rest: no inertia, no damping
    Vec3 torque_nm{};  ///< likewise, about the tool's origin
    Mat6 stiffness{};  ///< static: the free nodes follow until they are at rest. N/m, N, N m
    Mat6 damping{};    ///< of what follows. N s/m, N s, N m s
    Mat6 mass{};       ///< of what follows within a haptic period. kg, kg m, kg m^2
    Vec3 normal{};     ///< unit, the mean direction in which the object pushes the tool; zero without contact
    double radius_m = 0;      ///< how far from the origin the view is fair
    bool unilateral = false;  ///< the tool may leave: the force along the normal is never a pull
    std::uint32_t touched_nodes = 0;
    std::uint64_t step = 0;  ///< number of the step since reset(), from 1; 0: no model
};

}  // namespace knead
