// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/prescribed_unknowns.h"

#include <fmt/format.h>

#include <cmath>

#include "common/error.h"
#include "reference/elastic_body.h"

namespace knead::tools {
namespace {

void check_sizes(const PrescribedMotion& motion) {
    if (motion.displacement_m.size() != motion.nodes.size())
        fail_input(fmt::format("prescribed motion: {} displacements for {} nodes",
                               motion.displacement_m.size(), motion.nodes.size()));
    if (!motion.axes.empty() && motion.axes.size() != motion.nodes.size())
        fail_input(
            fmt::format("prescribed motion: {} axes for {} nodes", motion.axes.size(), motion.nodes.size()));
}

}  // namespace

PrescribedUnknowns spread(const PrescribedMotion& motion, const Eigen::VectorXd& rest_m) {
    check_sizes(motion);
    PrescribedUnknowns result{std::vector<bool>(static_cast<std::size_t>(rest_m.size())), rest_m};
    for (std::size_t k = 0; k < motion.nodes.size(); ++k) {
        const std::size_t node = motion.nodes[k];
        const unsigned axes = motion.axes.empty() ? unsigned{kAllAxes} : unsigned{motion.axes[k]};
        if (3 * node >= result.is_prescribed.size())
            fail_input(
                fmt::format("prescribed motion: node {} of {} does not exist", node, rest_m.size() / 3));
        if (axes == 0 || axes > kAllAxes)
            fail_input(fmt::format("prescribed motion: node {} has axes {}, not 1 to 7", node, axes));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if ((axes >> axis & 1u) == 0) continue;
            const double displacement = motion.displacement_m[k][axis];
            if (!std::isfinite(displacement))
                fail_input(fmt::format("prescribed motion: displacement of node {} is not finite", node));
            if (result.is_prescribed[3 * node + axis])
                fail_input(fmt::format("prescribed motion: node {} is given twice", node));
            result.is_prescribed[3 * node + axis] = true;
            result.target_m[static_cast<Eigen::Index>(3 * node + axis)] += displacement;
        }
    }
    return result;
}

Eigen::VectorXd to_unknowns(const std::vector<Point>& points, std::size_t node_count, const char* what) {
    if (points.size() != node_count)
        fail_input(fmt::format("{}: {} entries for {} nodes", what, points.size(), node_count));
    Eigen::VectorXd unknowns(3 * static_cast<Eigen::Index>(node_count));
    for (std::size_t n = 0; n < node_count; ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            unknowns[static_cast<Eigen::Index>(3 * n + axis)] = points[n][axis];
    if (!unknowns.allFinite()) fail_input(fmt::format("{}: not all numbers are finite", what));
    return unknowns;
}

std::vector<Point> to_points(const Eigen::VectorXd& unknowns) {
    std::vector<Point> points(static_cast<std::size_t>(unknowns.size()) / 3);
    for (std::size_t n = 0; n < points.size(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            points[n][axis] = unknowns[static_cast<Eigen::Index>(3 * n + axis)];
    return points;
}

std::vector<Point> reactions(const PrescribedMotion& motion, const Eigen::VectorXd& holding_n) {
    std::vector<Point> result;
    result.reserve(motion.nodes.size());
    for (const std::uint32_t node : motion.nodes) {
        const Eigen::Index x = first_unknown(node);
        result.push_back({-holding_n[x], -holding_n[x + 1], -holding_n[x + 2]});
    }
    return result;
}

}  // namespace knead::tools
