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
    std::vector<std::uint32_t> status;           ///< [steps] runtime only
    std::size_t let_slide = 0;                   ///< reference only
    double farthest_touch_m = 0;  ///< runtime only: of what it holds from the tool's surface
};

/// What the reference solves in a step.
enum class Oracle { linearised, converged };

[[nodiscard]] Record run_runtime(const ContactScene& scene, const Motion& motion, double dt_s, int steps,
                              SimulationConfig config = {});
[[nodiscard]] Record run_reference(const ContactScene& scene, const Motion& motion, double dt_s, int steps,
                                Oracle oracle);

/// How far a run is from another, of one tool.
struct Difference {
    double largest_force_n = 0;         ///< of the second
    double force = 0;                   ///< largest error over largest_force_n
    double force_while_same = 0;        ///< in steps in which the touched sets are the same
    double force_since_same = 0;        ///< before the first step in which they are not
    double torque = 0;                  ///< over the largest torque of the second, about the tool's origin
    int worst_step = 0;
    int touching_steps = 0;             ///< in either
    int steps_apart = 0;                ///< sets differ
    int longest_apart = 0;              ///< steps in a row
    std::size_t most_apart = 0;         ///< nodes, in a step
};
[[nodiscard]] Difference difference(const Record& run, const Record& truth, std::size_t tool);

[[nodiscard]] std::string text(const Difference& d);

}  // namespace knead::test
