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
/// The force on the hand (with a coupling: on the tool) at a small twist d away, moving with w and
/// accelerating with a, is load - stiffness d - damping w - mass a, where load = (force_n, torque_nm). All
/// three matrices are symmetric and positive semidefinite; rows and columns of the rotations are zero unless
/// the simulation was asked for torques. What the tool holds follows it: bonded and sticking nodes whole,
/// others along the normal; friction stays the load that it is. Matrices are those of the last step's
/// linearisation: that a load turns with the tool is not in them.
/// Source: docs/simulation.md, "The linear view".
struct LocalModel {
    Pose origin;       ///< of the tool, at the end of the step
    Vec3 force_n{};    ///< on the hand there, with the tool at rest: no inertia, no damping
    Vec3 torque_nm{};  ///< likewise, about the tool's origin
    Mat6 stiffness{};  ///< static: the free nodes follow until they are at rest. N/m, N, N m
    /// What motion radiates into the object, and the scene's own damping. N s/m, N s, N m s. With the mass
    /// it makes motions between two steps (a few ms) what they are in the whole object.
    Mat6 damping{};
    Mat6 mass{};    ///< of what moves along at that time scale. kg, kg m, kg m^2
    Vec3 normal{};  ///< unit, the mean direction in which the object pushes the tool; zero without contact
    /// How far from the origin the view is fair: until about a quarter of the touched nodes (at least one)
    /// would be let go or as many caught, and a quarter of the mean edge at most. Without contact: the gap.
    double radius_m = 0;
    bool unilateral = false;  ///< the tool may leave: the force along the normal is never a pull
    bool converged = true;    ///< false: stiffness may be too large yet; the next call goes on from here
    std::uint32_t touched_nodes = 0;
    std::uint32_t solver_iterations = 0;  ///< that the matrices have cost
    std::uint64_t step = 0;               ///< number of the step since reset(), from 1; 0: no model
};

}  // namespace knead
