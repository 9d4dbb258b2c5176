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

/// Marks a tied node's unknowns as given, by what its masters do not make of its position.
void add_tie(const TiedNode& tie, const Eigen::VectorXd& rest_m, PrescribedUnknowns& result) {
    if (3 * std::size_t{tie.node} >= result.is_prescribed.size())
        fail_input(fmt::format("tied node {} of {} does not exist", tie.node, rest_m.size() / 3));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (result.is_prescribed[3 * std::size_t{tie.node} + axis])
            fail_input(fmt::format("tied node {} is prescribed or tied twice", tie.node));
        result.is_prescribed[3 * std::size_t{tie.node} + axis] = true;
        const auto unknown = first_unknown(tie.node) + static_cast<Eigen::Index>(axis);
        double given_m = rest_m[unknown] + tie.displacement_m[axis];
        for (const auto& [master, weight] : tie.masters) {
            if (3 * std::size_t{master} >= result.is_prescribed.size() || !std::isfinite(weight))
                fail_input(fmt::format("tied node {}: its master {} does not exist or has no weight",
                                       tie.node, master));
            given_m -= weight * rest_m[first_unknown(master) + static_cast<Eigen::Index>(axis)];
        }
        if (!std::isfinite(given_m))
            fail_input(fmt::format("tied node {}: displacement is not finite", tie.node));
        result.target_m[unknown] = given_m;
    }
}

}  // namespace

PrescribedUnknowns spread(const PrescribedMotion& motion, const Eigen::VectorXd& rest_m) {
    if (!motion.ties.empty()) fail_input("tied nodes are for static problems without contact");
    return spread_with_ties(motion, rest_m);
}

PrescribedUnknowns spread_with_ties(const PrescribedMotion& motion, const Eigen::VectorXd& rest_m) {
    check_sizes(motion);
    PrescribedUnknowns result{std::vector<bool>(static_cast<std::size_t>(rest_m.size())), rest_m,
                              motion.ties};
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
    for (const TiedNode& tie : motion.ties)
        add_tie(tie, rest_m, result);
    for (const TiedNode& tie : motion.ties)
        for (const auto& [master, weight] : tie.masters)
            for (const TiedNode& other : motion.ties)
                if (other.node == master)
                    fail_input(fmt::format("tied node {} is a master of tied node {}", master, tie.node));
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

std::vector<Point> tied_reactions(const PrescribedMotion& motion, const Eigen::VectorXd& holding_n) {
    std::vector<Point> result;
    for (const TiedNode& tie : motion.ties) {
        const Eigen::Index x = first_unknown(tie.node);
        result.push_back({-holding_n[x], -holding_n[x + 1], -holding_n[x + 2]});
    }
    return result;
}

}  // namespace knead::tools
