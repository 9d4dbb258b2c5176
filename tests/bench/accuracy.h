// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "bench/exact_step.h"
#include "bench/motion.h"
#include "knead/runtime/simulation.h"

namespace knead::bench {

/// Forces below this share of the largest of the run are compared with that share of it.
inline constexpr double kSmallestForceShare = 0.01;

/// What is compared with exact steps, and how often.
struct AccuracyRequest {
    Motion motion;
    double dt_s = 1e-3;
    int sample_every = 5;  ///< steps; every step among the first kColdSteps of a motion
};
inline constexpr int kColdSteps = 10;

/// How right one motion's forces were. Errors are relative to max(|F exact|, kSmallestForceShare * the
/// largest exact force along the trajectory).
struct Accuracy {
    /// From the simulation's own state before the step the exact step was taken; largest error, over all
    /// sampled steps and over those whose status was ok.
    double step_error = 0;
    double step_error_when_ok = 0;
    /// Exact steps alone, along the same motion from rest, against the simulation's force at every step.
    double trajectory_error = 0;
    double largest_exact_force_n = 0;
    double largest_force_n = 0;  ///< of the simulation
    double mean_iterations = 0;
    std::uint32_t largest_iterations = 0;
    int steps = 0;
    int not_converged_steps = 0;
    int not_finite_steps = 0;
    int other_status_steps = 0;
    bool finite = true;              ///< every force and position
    double final_deformation_m = 0;  ///< root mean square distance of all nodes from rest at the end
    std::vector<Vec3> forces_n;      ///< [steps]
};

/// Resets the simulation and takes it through the motion.
[[nodiscard]] Accuracy measure_accuracy(Simulation& simulation, const Body& body,
                                        const AccuracyRequest& request);

/// The baseline's step force error along a motion, by the same measure.
[[nodiscard]] double baseline_step_error(const Body& body, const AccuracyRequest& request);

}  // namespace knead::bench
