// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "knead/formats/asset_object.h"
#include "knead/runtime/simulation.h"
#include "reference/contact_problem.h"
#include "stability/press_asset.h"
#include "stability/scenario_press.h"

namespace knead::test {

inline Eigen::Vector3d vec(const std::array<double, 3>& v) {
    return {v[0], v[1], v[2]};
}

/// One body for the runtime and for the reference: the same nodes in the same order.
struct ContactScene {
    Asset asset;
    TetMesh mesh;
    Material material;
    tools::PrescribedMotion held;
};

/// The reference's view of an asset.
inline ContactScene scene_of(Asset asset) {
    ContactScene scene;
    MaterialObject object = object_of(asset);
    scene.mesh = std::move(object.mesh);
    scene.material = std::move(object.material);
    for (auto n = asset.free_node_count; n < asset.nodes_m.size(); ++n)
        scene.held.nodes.push_back(n);
    scene.held.displacement_m.assign(scene.held.nodes.size(), Point{});
    scene.asset = std::move(asset);
    return scene;
}

/// The paper's cube under one of the nine scenarios, standing on held nodes, without tools.
inline Asset scenario_cube(std::uint32_t cells, double poissons_ratio = kCubePoissonsRatio,
                           int scenario = 1) {
    Asset asset = press_asset(PressedCube({scenario, cells}, poissons_ratio)).asset;
    asset.tools.clear();
    return asset;
}

/// Free nodes of the asset's surface with a coordinate of `value_m`.
inline std::vector<std::uint32_t> nodes_on(const Asset& asset, std::size_t axis, double value_m) {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t n = 0; n < asset.free_node_count; ++n)
        if (std::abs(asset.nodes_m[n][axis] - value_m) < 1e-9) nodes.push_back(n);
    return nodes;
}

/// A tool above the middle of the cube's top face, just touching; a capsule lies along y.
inline ToolSet tool_above(const Asset& asset, ToolShape shape, ToolContact contact) {
    ToolSet tool;
    tool.name = "tool";
    tool.shape = shape;
    tool.contact = contact;
    tool.rest_position_m = {kCubeSideM / 2, kCubeSideM / 2, kCubeSideM};
    if (shape == ToolShape::sphere) tool.radius_m = 0.04;
    if (shape == ToolShape::capsule) {
        tool.radius_m = 0.03;
        tool.half_length_m = 0.03;
        tool.rest_orientation_wxyz = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};
    }
    tool.rest_position_m[2] += tool.radius_m;
    if (contact == ToolContact::coulomb) tool.friction_coefficient = 0.4;
    tool.nodes = nodes_on(asset, 2, kCubeSideM);
    return tool;
}

/// `rest` moved by `way_m` and turned about an axis of the scene through its own origin.
inline Pose moved(const Pose& rest, const Vec3& way_m, const Eigen::AngleAxisd& turn) {
    Pose pose = rest;
    for (std::size_t k = 0; k < 3; ++k)
        pose.position_m[k] += way_m[k];
    const auto& q = rest.orientation_wxyz;
    const Eigen::Quaterniond turned = Eigen::Quaterniond(turn) * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    pose.orientation_wxyz = {turned.w(), turned.x(), turned.y(), turned.z()};
    return pose;
}

/// Smoothly from 0 at `start` to 1 at `end`.
inline double ramp(double time, double start, double end) {
    const double t = std::clamp((time - start) / (end - start), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace knead::test
