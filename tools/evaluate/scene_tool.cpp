// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/scene_tool.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "common/error.h"

namespace knead::tools {
namespace {

/// Nodes are told apart by their coordinates, which baking copies bit for bit.
std::map<Point, std::uint32_t> nodes_by_place(const std::vector<Point>& nodes_m) {
    std::map<Point, std::uint32_t> places;
    for (std::uint32_t n = 0; n < nodes_m.size(); ++n)
        places.emplace(nodes_m[n], n);
    return places;
}

}  // namespace

RigidPose ToolPress::pose_at_end() const {
    RigidPose pose{tool.rest_position_m, tool.rest_orientation_wxyz};
    for (std::size_t axis = 0; axis < 3; ++axis)
        pose.position_m[axis] += way_m * direction[axis];
    return pose;
}

ToolPress tool_press(const Asset& asset, std::size_t tool, const TetMesh& mesh, const Box& object) {
    ToolPress press;
    press.tool = asset.tools.at(tool);
    const auto places = nodes_by_place(mesh.nodes_m);
    for (std::uint32_t& node : press.tool.nodes)
        node = places.at(asset.nodes_m[node]);
    std::sort(press.tool.nodes.begin(), press.tool.nodes.end());
    const auto& [w, x, y, z] = press.tool.rest_orientation_wxyz;
    const Eigen::Vector3d down = Eigen::Quaterniond(w, x, y, z) * Eigen::Vector3d(0, 0, -1);
    const Point size = object.size_m();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        press.direction[axis] = down[static_cast<int>(axis)];
        press.way_m += kScenePress * std::abs(press.direction[axis]) * size[axis];
    }
    return press;
}

AppliedLoad apply_press(const ToolPress& press, const std::vector<bool>& is_held) {
    AppliedLoad load;
    for (std::uint32_t n = 0; n < is_held.size(); ++n)
        if (is_held[n]) load.motion.nodes.push_back(n);
    load.held_count = load.motion.nodes.size();
    load.motion.displacement_m.assign(load.held_count, Point{});
    Point shift = press.direction;
    for (double& x : shift)
        x *= press.way_m;
    for (const std::uint32_t node : press.tool.nodes) {
        load.motion.nodes.push_back(node);
        load.motion.displacement_m.push_back(shift);
        load.work_directions.push_back(press.direction);
    }
    return load;
}

void replace_tools(Asset& asset, const AppliedLoad& load, const TetMesh& mesh) {
    const auto places = nodes_by_place(asset.nodes_m);
    ToolSet tool;
    tool.name = "load";
    tool.shape = ToolShape::plate;
    tool.contact = ToolContact::bonded;
    for (std::size_t k = load.held_count; k < load.motion.nodes.size(); ++k)
        tool.nodes.push_back(places.at(mesh.nodes_m[load.motion.nodes[k]]));
    std::sort(tool.nodes.begin(), tool.nodes.end());
    tool.rest_position_m = asset.nodes_m[tool.nodes.front()];
    asset.tools = {tool};
}

}  // namespace knead::tools
