// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace knead {

/// Choices of the application that do not belong to the asset.
struct SimulationConfig {
    /// Which of the asset's tools the poses of step() move. The asset's other tools are not in this
    /// simulation.
    std::size_t tool = 0;
    double force_tolerance = 1e-4;    ///< relative bound aimed at for the force error of one step, (0, 0.1]
    int max_solver_iterations = 500;  ///< of the conjugate gradients, per solve, > 0
    int max_contact_passes = 8;       ///< solves, with a changed touched set each, tried in one step, > 0

    /// Spring and damper between the pose that step() is given (the hand) and the tool in the scene, solved
    /// together with the object. Zero stiffness: no coupling, the tool is at the given pose.
    double coupling_stiffness_n_per_m = 0;
    double coupling_damping_n_s_per_m = 0;
    double tool_mass_kg = 0.05;  ///< used with a coupling only, > 0
};

}  // namespace knead
