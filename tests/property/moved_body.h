// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "knead/formats/asset.h"
#include "knead/runtime/simulation.h"
#include "support/random.h"
#include "support/simulation_of.h"
#include "unit/runtime/block_asset.h"

namespace knead::test {

using Eigen::Matrix3d;
using Eigen::Vector3d;

inline Vector3d vector_of(const Point& p) {
    return {p[0], p[1], p[2]};
}
inline Point point_of(const Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

/// A jittered block of every elasticity on its own, bottom held, a plate bonded to its top, with gravity and
/// damping. Everything that a rule about descriptions could get wrong is in it.
inline Asset any_body(std::uint64_t seed) {
    Random random(seed);
    TetMesh mesh = kuhn_box(2, 3, 2, {0.06, 0.09, 0.08});
    constexpr double kJitter_m = 0.004;  // 0.13 of a cell: no tetrahedron is inverted
    for (Point& node : mesh.nodes_m)
        for (double& x : node)
            x += random.uniform(-kJitter_m, kJitter_m);
    Asset asset = asset_of(mesh, [](const Point& p) { return p[2] < 0.02; });
    make_heterogeneous(asset, seed);
    for (PaletteEntry& entry : asset.palette) {
        entry.poissons_ratio = random.uniform(0.0, 0.45);
        entry.density_kg_per_m3 = random.uniform(500, 2000);
    }
    asset.gravity_m_per_s2 = {1.5, -2.5, -9};
    asset.damping_per_s = 2;
    ToolSet tool;
    tool.name = "plate";
    tool.contact = ToolContact::bonded;
    tool.rest_position_m = {0.03, 0.045, 0.08};
    tool.nodes = free_nodes(asset, [](const Point& p) { return p[2] > 0.06; });
    asset.tools = {tool};
    return asset;
}

/// The tool's way: a press with a slide and a turn, told in the scene's frame.
struct ToolMotion {
    Vector3d slide_m{0.002, -0.003, -0.009};
    Vector3d turn_rad{0.15, 0.1, 0.3};
    double dt_s = 4e-3;
    int steps = 12;

    [[nodiscard]] Pose pose_after(const Asset& asset, int step) const {
        const double share = static_cast<double>(step) / steps;
        const ToolSet& tool = asset.tools[0];
        const auto& q = tool.rest_orientation_wxyz;
        const Eigen::Quaterniond turned = Eigen::AngleAxisd(share * turn_rad.norm(), turn_rad.normalized()) *
                                          Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
        return {point_of(vector_of(tool.rest_position_m) + share * slide_m),
                {turned.w(), turned.x(), turned.y(), turned.z()}};
    }
};

/// What came of it.
struct Trace {
    std::vector<Vector3d> forces_n, torques_nm;  ///< [steps]
    std::vector<Vector3d> positions_m;           ///< [nodes] after the last one
    std::uint32_t status = kStepOk;              ///< bits of all steps
    double largest_force_n = 0;
};

inline SimulationConfig exact_config(double dt_s) {
    SimulationConfig config;
    config.arithmetic = Arithmetic::float64;
    config.expected_dt_s = dt_s;
    config.force_tolerance = 1e-9;  // so that descriptions are compared, not where a solver stops
    config.with_torque = true;
    return config;
}

inline Trace run(const Asset& asset, const ToolMotion& motion, const SimulationConfig& config) {
    Simulation simulation = simulation_of(asset, config);
    Trace trace;
    for (int step = 1; step <= motion.steps; ++step) {
        const StepResult result = simulation.step(motion.pose_after(asset, step), motion.dt_s);
        trace.forces_n.push_back(vector_of(result.force_n));
        trace.torques_nm.push_back(vector_of(result.torque_nm));
        trace.status |= result.status;
        trace.largest_force_n = std::max(trace.largest_force_n, trace.forces_n.back().norm());
    }
    for (std::size_t n = 0; n < simulation.node_count(); ++n)
        trace.positions_m.emplace_back(simulation.positions_m() + 3 * n);
    return trace;
}

inline Trace run(const Asset& asset, const ToolMotion& motion = {}) {
    return run(asset, motion, exact_config(motion.dt_s));
}

/// @param size_m how far the largest difference of positions may be, relative to it
struct Difference {
    double force = 0;       ///< largest over the steps, relative to the largest force
    double torque = 0;      ///< likewise, over the largest torque
    double position_m = 0;  ///< largest over the nodes at the end
};

/// How far `found` is from what `map` makes of `expected`. @param node place in `found` of each node
template <class Force, class Torque, class Place>
Difference difference(const Trace& found, const Trace& expected, const Force& map_force,
                      const Torque& map_torque, const Place& map_place,
                      const std::vector<std::uint32_t>& node = {}) {
    Difference result;
    double force_scale = 0, torque_scale = 0;
    for (std::size_t k = 0; k < expected.forces_n.size(); ++k) {
        const Vector3d force = map_force(expected.forces_n[k]);
        const Vector3d torque = map_torque(expected.torques_nm[k]);
        force_scale = std::max(force_scale, force.norm());
        torque_scale = std::max(torque_scale, torque.norm());
        result.force = std::max(result.force, (found.forces_n[k] - force).norm());
        result.torque = std::max(result.torque, (found.torques_nm[k] - torque).norm());
    }
    result.force /= force_scale;
    result.torque /= torque_scale;
    for (std::size_t n = 0; n < expected.positions_m.size(); ++n) {
        const Vector3d place = map_place(expected.positions_m[n]);
        result.position_m =
            std::max(result.position_m, (found.positions_m[node.empty() ? n : node[n]] - place).norm());
    }
    return result;
}

}  // namespace knead::test
