// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/selection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knead::tools {
namespace {

struct Box {
    Point low;
    Point high;
    [[nodiscard]] double longest_edge() const {
        return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    }
};

Box bounding_box(const TetMesh& mesh) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (const Point& node : mesh.nodes_m) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::min(box.low[axis], node[axis]);
            box.high[axis] = std::max(box.high[axis], node[axis]);
        }
    }
    return box;
}

bool on_side(const Point& node, const std::string& side, const Box& box, double tolerance) {
    if (side == "left") return node[0] <= box.low[0] + tolerance;
    if (side == "right") return node[0] >= box.high[0] - tolerance;
    if (side == "front") return node[1] <= box.low[1] + tolerance;
    if (side == "back") return node[1] >= box.high[1] - tolerance;
    if (side == "bottom") return node[2] <= box.low[2] + tolerance;
    if (side == "top") return node[2] >= box.high[2] - tolerance;
    return true;  // "all", or no side asked for
}

bool inside_box(const Point& node, const std::array<Point, 2>& box, double tolerance) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (node[axis] < box[0][axis] - tolerance || node[axis] > box[1][axis] + tolerance) return false;
    return true;
}

bool inside_ball(const Point& node, const std::pair<Point, double>& ball, double tolerance) {
    const auto& [centre, radius] = ball;
    return std::hypot(node[0] - centre[0], node[1] - centre[1], node[2] - centre[2]) <= radius + tolerance;
}

}  // namespace

std::vector<bool> select_nodes(const TetMesh& mesh, const Selection& selection) {
    const Box bounds = bounding_box(mesh);
    const double tolerance = kSideTolerance * bounds.longest_edge();
    std::vector<bool> selected(mesh.nodes_m.size());
    for (std::size_t i = 0; i < selected.size(); ++i) {
        const Point& node = mesh.nodes_m[i];
        selected[i] = on_side(node, selection.side, bounds, tolerance) &&
                      (!selection.box_m || inside_box(node, *selection.box_m, tolerance)) &&
                      (!selection.ball_m || inside_ball(node, *selection.ball_m, tolerance));
    }
    return selected;
}

}  // namespace knead::tools
