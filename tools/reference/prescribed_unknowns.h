// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/static_problem.h"

namespace knead::tools {

/// A prescribed motion spread over the unknowns; unknown 3 * n + i is axis i of node n.
struct PrescribedUnknowns {
    std::vector<bool> is_prescribed;  ///< [3 nodes]
    /// [3 nodes] position asked for; the rest position where free. Where tied: the part of the position that
    /// the masters do not make (FreeSystem::given).
    Eigen::VectorXd target_m;
    std::vector<TiedNode> ties;
};

/// @throws ToolError(bad_input) when the motion breaks an invariant of its type, or has ties
[[nodiscard]] PrescribedUnknowns spread(const PrescribedMotion& motion, const Eigen::VectorXd& rest_m);
/// The same for who can do with ties; tied unknowns count as prescribed.
[[nodiscard]] PrescribedUnknowns spread_with_ties(const PrescribedMotion& motion,
                                                  const Eigen::VectorXd& rest_m);

/// Node by node, three numbers each, to a vector of unknowns and back.
/// @throws ToolError(bad_input) when the count is not `node_count` or a number is not finite
[[nodiscard]] Eigen::VectorXd to_unknowns(const std::vector<Point>& points, std::size_t node_count,
                                          const char* what);
[[nodiscard]] std::vector<Point> to_points(const Eigen::VectorXd& unknowns);

/// What the object exerts on the holders of the prescribed nodes, given the force needed to hold each node.
[[nodiscard]] std::vector<Point> reactions(const PrescribedMotion& motion, const Eigen::VectorXd& holding_n);
[[nodiscard]] std::vector<Point> tied_reactions(const PrescribedMotion& motion,
                                                const Eigen::VectorXd& holding_n);

}  // namespace knead::tools
