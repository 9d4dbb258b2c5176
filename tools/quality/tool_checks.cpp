// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "quality/gate.h"
#include "quality/tool_place.h"

namespace knead::tools {
namespace {

/// A contact of fewer elements is a few nodes: the force jumps as each of them is caught.
constexpr double kElementsPerTool = 2;
constexpr double kRounding = 1e-9;  ///< of a tool that is exactly that wide
/// Share of the object's extent that a tool may overlap it at rest: rounding of positions in a scene file.
constexpr double kOverlapAtRest = 1e-6;

/// Mean of the shortest edges of the tetrahedra that the tool touches: in a regular grid the side of a cell.
double edge_at_tool_m(const Asset& asset, const ToolSet& tool) {
    std::vector<bool> touched(asset.nodes_m.size(), false);
    for (const std::uint32_t node : tool.nodes)
        touched[node] = true;
    double sum_m = 0;
    std::size_t count = 0;
    for (const Tetrahedron& t : asset.tetrahedra) {
        if (std::none_of(t.begin(), t.end(), [&](std::uint32_t node) { return touched[node]; })) continue;
        sum_m += shape_of(asset.nodes_m[t[0]], asset.nodes_m[t[1]], asset.nodes_m[t[2]], asset.nodes_m[t[3]])
                     .shortest_edge_m;
        ++count;
    }
    return sum_m / static_cast<double>(count);
}

/// Narrowest width with which a tool touches; infinite for an unbounded plate.
double width_m(const Asset& asset, const ToolSet& tool) {
    if (tool.shape != ToolShape::plate) return 2 * tool.radius_m;
    if (tool.half_extents_m[0] > 0) return 2 * std::min(tool.half_extents_m[0], tool.half_extents_m[1]);
    if (tool.contact != ToolContact::bonded) return std::numeric_limits<double>::infinity();
    // An unbounded plate that is bonded is as large as what hangs on it.
    Point low = asset.nodes_m[tool.nodes.front()], high = low;
    for (const std::uint32_t node : tool.nodes)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], asset.nodes_m[node][axis]);
            high[axis] = std::max(high[axis], asset.nodes_m[node][axis]);
        }
    std::array<double, 3> sides{high[0] - low[0], high[1] - low[1], high[2] - low[2]};
    std::sort(sides.begin(), sides.end());
    return sides[1];  // the shortest is its thickness
}

void examine_size(const Asset& asset, const ToolSet& tool, Findings& findings) {
    const double width = width_m(asset, tool);
    const double edge = edge_at_tool_m(asset, tool);
    if (width < (1 - kRounding) * kElementsPerTool * edge)
        findings.push_back(
            {true, "tool-small", width / edge, "elements",
             fmt::format(
                 "tool {} is {:.3g} m wide, the object's elements there {:.3g} m: it is smaller than two "
                 "coarse elements, and {}",
                 tool.name, width, edge,
                 tool.contact == ToolContact::bonded ? "its force depends on where its few nodes are"
                                                     : "may sink in between nodes"),
             "use a finer mesh for this level, or a larger tool"});
}

void examine_distance(const MeshQuality& mesh, const ToolSet& tool, double nearest_m, Findings& findings) {
    if (nearest_m > mesh.extent_m())
        findings.push_back(
            {true, "tool-far", nearest_m, "m",
             fmt::format("tool {} is {:.3g} m away from the nearest node that it may touch, farther than the "
                         "object is long",
                         tool.name, nearest_m),
             "check the unit of position, or leave position out: the tool then stands on its highest node"});
}

/// How a unilateral tool starts, and whether a plate that goes straight on meets any of its nodes.
void examine_way(const Asset& asset, const MeshQuality& mesh, const ToolSet& tool, Findings& findings) {
    ToolGap nearest;
    nearest.beside_m = nearest.distance_m = std::numeric_limits<double>::infinity();
    for (const std::uint32_t node : tool.nodes) {
        const ToolGap gap = gap_of(tool, asset.nodes_m[node]);
        nearest.beside_m = std::min(nearest.beside_m, gap.beside_m);
        nearest.distance_m = std::min(nearest.distance_m, gap.distance_m);
        if (gap.beside_m == 0) nearest.overlap_m = std::max(nearest.overlap_m, gap.overlap_m);
    }
    examine_distance(mesh, tool, nearest.distance_m, findings);
    if (tool.shape == ToolShape::plate && nearest.beside_m > 0)
        findings.push_back(
            {true, "tool-misses", nearest.beside_m, "m",
             fmt::format("tool {} goes past all of its {} nodes when it moves straight on: the nearest stays "
                         "{:.3g} m beside it",
                         tool.name, tool.nodes.size(), nearest.beside_m),
             "correct position, orientation_wxyz or touches of this tool (its face looks along its own -z)"});
    else if (nearest.overlap_m > kOverlapAtRest * mesh.extent_m())
        findings.push_back(
            {true, "tool-starts-inside", nearest.overlap_m, "m",
             fmt::format("tool {} is {:.3g} m inside the object at rest: the first step pushes with that",
                         tool.name, nearest.overlap_m),
             "move its position out, or leave position out: it then stands on its highest node"});
}

void examine_bonded_place(const Asset& asset, const MeshQuality& mesh, const ToolSet& tool,
                          Findings& findings) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const std::uint32_t node : tool.nodes) {
        const Point& p = asset.nodes_m[node];
        const Point& q = tool.rest_position_m;
        nearest_m = std::min(nearest_m, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    }
    examine_distance(mesh, tool, nearest_m, findings);
}

}  // namespace

Findings examine_tools(const Asset& asset, const MeshQuality& mesh) {
    Findings findings;
    for (const ToolSet& tool : asset.tools) {
        if (tool.nodes.empty()) {
            findings.push_back({true, "tool-touches-nothing", 0, "",
                                fmt::format("tool {} may touch no node at all", tool.name),
                                "correct its touches"});
            continue;
        }
        examine_size(asset, tool, findings);
        if (tool.contact == ToolContact::bonded)
            examine_bonded_place(asset, mesh, tool, findings);
        else
            examine_way(asset, mesh, tool, findings);
    }
    return findings;
}

}  // namespace knead::tools
