// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <stdexcept>
#include <vector>

#include "property/moved_body.h"

namespace knead::test {

/// What the runtime comes to under tools that stand still.
struct Rest {
    std::vector<Vector3d> forces_n;  ///< [tools]
    Eigen::VectorXd positions_m;     ///< [3 nodes]
};

/// Steps of 20 ms, the longest: implicit Euler damps the most there. Still: no node moves by more than
/// `still_m` in a step.
/// @throws std::runtime_error when it does not come to rest
inline Rest settle(Simulation& simulation, const std::vector<Pose>& poses, double still_m) {
    constexpr double kDt_s = 20e-3;
    constexpr int kLongest = 4000;
    const auto size = static_cast<Eigen::Index>(3 * simulation.node_count());
    Eigen::VectorXd before = Eigen::VectorXd::Zero(size);
    for (int step = 0; step < kLongest; ++step) {
        if (!is_solved(simulation.step(poses.data(), kDt_s).status))
            throw std::runtime_error("a step failed");
        const Eigen::VectorXd now = Eigen::Map<const Eigen::VectorXd>(simulation.positions_m(), size);
        const double moved = (now - before).lpNorm<Eigen::Infinity>();
        before = now;
        if (step > 2 && moved < still_m) {
            Rest rest{{}, now};
            for (std::size_t k = 0; k < poses.size(); ++k)
                rest.forces_n.push_back(vector_of(simulation.tool(k).force_n));
            return rest;
        }
    }
    throw std::runtime_error("the object does not come to rest");
}

inline Pose moved(Pose pose, const Vector3d& shift_m) {
    pose.position_m = point_of(vector_of(pose.position_m) + shift_m);
    return pose;
}

}  // namespace knead::test
