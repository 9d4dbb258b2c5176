// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace knead {

/// What the numbers of a step are.
enum class Arithmetic : std::uint8_t {
    automatic = 0,  ///< as knead/formats/numerics.h chooses for the asset
    float32 = 1,
    float64 = 2,
    mixed = 3  ///< the state in float64, the solve in float32
};

/// Choices of the application that do not belong to the asset.
struct SimulationConfig {
    /// Which of the asset's tools the poses of step() move, by index, each once; at least one. The asset's
    /// other tools are not in this simulation.
    std::vector<std::size_t> tools{0};
    /// The step that the application will ask for most, seconds: what the preconditioner is made for when
    /// loading. Other steps are as exact; they take more iterations until it has been made anew, step by
    /// step.
    double expected_dt_s = 1e-3;
    Arithmetic arithmetic = Arithmetic::automatic;
    double force_tolerance = 3e-4;    ///< relative bound of the force error of one step, (0, 0.1]
    int max_solver_iterations = 500;  ///< of the conjugate gradients, per solve, > 0
    int max_contact_passes = 32;      ///< solves, with a changed touched set each, tried in one step, > 0
    /// Times that one step may be linearised, each of them a pass over the tetrahedra and a solve; >= 0.
    /// 0: once, or up to 8 times in steps above 2.5 ms of matter that needs it: stiff islands (1e5) in nearly
    /// incompressible matter, flat tetrahedra (docs/simulation.md). More are tried only while the solution
    /// still moves.
    int max_linearisations = 0;
    bool with_torque = false;       ///< also find the torque on each tool
    bool with_local_model = false;  ///< make room for Simulation::local_model(): 12 vectors of all nodes for
                                    ///< each tool, 24 with torque

    /// Spring and damper between the pose that step() is given (the hand) and the tool in the scene, solved
    /// together with the object. Zero stiffness: no coupling, the tool is at the given pose.
    double coupling_stiffness_n_per_m = 0;
    double coupling_damping_n_s_per_m = 0;
    double tool_mass_kg = 0.05;  ///< used with a coupling only, > 0
};

}  // namespace knead
