// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/plate_press.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace knead::tools {
namespace {

constexpr double kPlaneTolerance = 1e-9;  // of the height: coordinates that went through a text file

struct Box {
    Point low, high;
};

Box bounding_box(const TetMesh& mesh) {
    if (mesh.nodes_m.empty()) fail_input("plate press: the mesh has no nodes");
    Box box{mesh.nodes_m.front(), mesh.nodes_m.front()};
    for (const Point& node : mesh.nodes_m)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::min(box.low[axis], node[axis]);
            box.high[axis] = std::max(box.high[axis], node[axis]);
        }
    return box;
}

}  // namespace

PlatePress plate_press(const TetMesh& mesh, double strain, PlateSlip slip) {
    if (!std::isfinite(strain) || strain >= 1)
        fail_input(fmt::format("plate press: strain is {}, not finite and below 1", strain));
    const Box box = bounding_box(mesh);
    PlatePress press;
    press.height_m = box.high[2] - box.low[2];
    press.area_m2 = (box.high[0] - box.low[0]) * (box.high[1] - box.low[1]);
    if (!(press.height_m > 0)) fail_input("plate press: the mesh has no height along z");
    const double tolerance = kPlaneTolerance * press.height_m;
    for (std::uint32_t n = 0; n < mesh.nodes_m.size(); ++n) {
        const double z = mesh.nodes_m[n][2];
        if (z <= box.low[2] + tolerance) press.held_nodes.push_back(n);
        if (z >= box.high[2] - tolerance) press.plate_nodes.push_back(n);
    }
    const auto prescribe = [&](const std::vector<std::uint32_t>& nodes, double z_m, std::uint8_t axes) {
        press.motion.nodes.insert(press.motion.nodes.end(), nodes.begin(), nodes.end());
        press.motion.displacement_m.insert(press.motion.displacement_m.end(), nodes.size(), Point{0, 0, z_m});
        press.motion.axes.insert(press.motion.axes.end(), nodes.size(), axes);
    };
    prescribe(press.held_nodes, 0, kAllAxes);
    prescribe(press.plate_nodes, -strain * press.height_m, slip == PlateSlip::none ? kAllAxes : kAxisZ);
    return press;
}

Point force_on_plate_n(const PlatePress& press, const StaticSolution& solution) {
    Point force{0, 0, 0};
    for (std::size_t k = press.held_nodes.size(); k < solution.reactions_n.size(); ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            force[axis] += solution.reactions_n[k][axis];
    return force;
}

}  // namespace knead::tools
