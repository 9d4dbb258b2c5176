// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "stability/contact_scene.h"

namespace knead::test {

/// Poses of all tools at the end of a step. @param rest [tools]
using Motion = std::function<std::vector<Pose>(const std::vector<Pose>& rest, double time_s)>;

/// One sample of one tool.
struct ToolSample {
    Eigen::Vector3d force_n = Eigen::Vector3d::Zero();
    Eigen::Vector3d torque_n_m = Eigen::Vector3d::Zero();
    std::vector<std::uint32_t> touched;  ///< increasing
};

/// One run along a motion.
struct Record {
    std::vector<std::vector<ToolSample>> steps;  ///< [steps][tools]
    // Of the runtime only:
    std::uint32_t status = 0;           ///< bits of all steps
    std::vector<double> speed_m_per_s;  ///< [steps] of the fastest node at the end
    double farthest_touch_m = 0;        ///< of what it holds from the tool's surface
    // Of the reference only:
    int slid_at = 0;  ///< first step in which sticking nodes had to slide (ContactProblem), or 0
};

/// What the reference solves in a step.
enum class Oracle {
    linearised,  ///< once, where the runtime does: where velocities lead, and on by what the step before went
                 ///< beyond that, as far as it repeats itself
    converged
};

/// All tools of the scene, with torque. @throws std::runtime_error when the runtime refuses
[[nodiscard]] Record run_runtime(const ContactScene& scene, const Motion& motion, double dt_s, int steps,
                                 SimulationConfig config = {});
/// The reference's own trajectory. Linearised: at the point of the runtime, nodes caught where the runtime
/// catches them.
[[nodiscard]] Record run_reference(const ContactScene& scene, const Motion& motion, double dt_s, int steps,
                                   Oracle oracle);

/// How far a run is from another, of one tool. Errors of forces are relative to the largest of the second
/// run; those of torques to that force at half of the cube's side.
struct Difference {
    double largest_force_n = 0;
    double force = 0;          ///< in any step
    int worst_step = 0;        ///< from 1
    double settled_force = 0;  ///< in steps with the same nodes touched for kSettledSteps, in both runs
    double torque = 0;         ///< in any step
    double settled_torque = 0;
    int touching_steps = 0;      ///< in either
    int steps_apart = 0;         ///< the touched nodes differ
    int longest_apart = 0;       ///< steps in a row
    std::size_t most_apart = 0;  ///< nodes, in a step
};

/// A node's catch takes its inertia, mass / dt^2 for every metre: a micrometre between two trajectories is a
/// per mille of the force then, and it decays in a few steps.
inline constexpr int kSettledSteps = 20;

/// @param until the first step that is left out, or 0: all
[[nodiscard]] Difference difference(const Record& run, const Record& truth, std::size_t tool, int until = 0);

[[nodiscard]] std::string text(const Difference& d);

}  // namespace knead::test
