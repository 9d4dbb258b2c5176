// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability/truth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "reference/tool_surface.h"

namespace knead::tools::stability {
namespace {

/// Of the laws of contact: with friction the rounding of their sweeps is larger.
constexpr double kResidualInContact = 1e-6, kGapInContact = 1e-8;

Eigen::Vector3d vec(const Point& p) {
    return {p[0], p[1], p[2]};
}

Eigen::Matrix3d rotation(const Pose& pose) {
    const auto& q = pose.orientation_wxyz;
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

Eigen::VectorXd flat(const std::vector<Point>& points) {
    return Eigen::Map<const Eigen::VectorXd>(points[0].data(), static_cast<Eigen::Index>(3 * points.size()));
}

bool bonded(const ToolSet& tool) {
    return tool.contact == ToolContact::bonded;
}

}  // namespace

Eigen::Vector3d to_local(const Pose& pose, const Point& scene_m) {
    return rotation(pose).transpose() * (vec(scene_m) - vec(pose.position_m));
}

Truth::Truth(const Specimen& specimen)
    : specimen_(specimen),
      problem_(specimen.mesh, specimen.material,
               {specimen.asset.gravity_m_per_s2, specimen.asset.damping_per_s}),
      static_(specimen.mesh, specimen.material),
      body_(specimen.mesh, specimen.material) {}

/// The nodes that the runtime holds, of which it tells the count: those closest to the surface.
std::vector<Truth::NodeAt> Truth::touching(std::size_t k, const Snapshot& at) const {
    const ToolSet& set = specimen_.asset.tools[k];
    ContactTool tool = contact_tool(set, specimen_.asset.nodes_m);
    tool.pose = {at.tools[k].position_m, at.tools[k].orientation_wxyz};
    const ToolSurface surface(tool);
    std::vector<NodeAt> nodes;
    for (std::uint32_t slot = 0; slot < set.nodes.size(); ++slot) {
        const Point& node = at.state.positions_m[set.nodes[slot]];
        nodes.push_back({slot, std::abs(surface.nearest(surface.to_local(vec(node))).gap_m)});
    }
    std::stable_sort(nodes.begin(), nodes.end(),
                     [](const NodeAt& a, const NodeAt& b) { return a.gap_m < b.gap_m; });
    nodes.resize(std::min(nodes.size(), at.touched[k]));
    return nodes;
}

/// Relative to the tool, along its surface or off it.
bool Truth::slid(std::size_t k, std::uint32_t node, const Snapshot& before, const Snapshot& now) const {
    constexpr double kRounding = 1e-8;  // of float32 displacements, over the size
    const Eigen::Vector3d way = to_local(now.tools[k], now.state.positions_m[node]) -
                                to_local(before.tools[k], before.state.positions_m[node]);
    return way.norm() > kRounding * specimen_.size_m;
}

ContactTool Truth::tool_at(std::size_t k, const Snapshot& from, const Snapshot* before,
                           const Pose& to) const {
    const ToolSet& set = specimen_.asset.tools[k];
    ContactTool tool = contact_tool(set, specimen_.asset.nodes_m);
    tool.catch_place = CatchPlace::solved_without_it;  // as the runtime
    tool.before.assign(set.nodes.size(), NodeTouch{});
    for (const NodeAt& node : touching(k, from)) {
        const Eigen::Vector3d anchor = to_local(from.tools[k], from.state.positions_m[set.nodes[node.slot]]);
        const bool slides = set.contact == ToolContact::frictionless ||
                            (set.contact == ToolContact::coulomb && before != nullptr &&
                             slid(k, set.nodes[node.slot], *before, from));
        tool.before[node.slot] = {slides ? TouchMode::sliding : TouchMode::sticking,
                                  {anchor.x(), anchor.y(), anchor.z()}};
    }
    tool.pose_before = {from.tools[k].position_m, from.tools[k].orientation_wxyz};
    tool.pose = {to.position_m, to.orientation_wxyz};
    return tool;
}

PrescribedMotion Truth::with_bonded(const std::vector<Pose>& poses) const {
    PrescribedMotion held = specimen_.held;
    for (std::size_t k = 0; k < poses.size(); ++k) {
        const ToolSet& set = specimen_.asset.tools[k];
        if (!bonded(set)) continue;
        const Pose rest{set.rest_position_m, set.rest_orientation_wxyz};
        for (const std::uint32_t node : set.nodes) {
            const Point& home = specimen_.asset.nodes_m[node];
            const Eigen::Vector3d place =
                rotation(poses[k]) * to_local(rest, home) + vec(poses[k].position_m);
            held.nodes.push_back(node);
            held.displacement_m.push_back({place.x() - home[0], place.y() - home[1], place.z() - home[2]});
        }
    }
    return held;
}

/// Positions come out rounded to float32, but those of bonded nodes are kept in double: their inertia is read
/// from changes that are far smaller.
MotionState Truth::exactly_bonded(const Snapshot& at) const {
    MotionState state = at.state;
    const PrescribedMotion places = with_bonded(at.tools);
    for (std::size_t i = specimen_.held.nodes.size(); i < places.nodes.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            state.positions_m[places.nodes[i]][k] =
                specimen_.asset.nodes_m[places.nodes[i]][k] + places.displacement_m[i][k];
    return state;
}

Truth::Forces Truth::step(const Snapshot& from, const std::vector<Pose>& to, double dt_s, Step kind,
                          double residual, const Snapshot* before) {
    const PrescribedMotion held = with_bonded(to);
    const MotionState state = exactly_bonded(from);
    std::vector<ContactTool> tools;
    for (std::size_t k = 0; k < to.size(); ++k)
        if (!bonded(specimen_.asset.tools[k])) tools.push_back(tool_at(k, from, before, to[k]));
    ContactLimits limits;
    limits.relative_residual = tools.empty() ? residual : std::max(residual, kResidualInContact);
    limits.relative_gap = kGapInContact;
    const ContactSolution solution = kind == Step::linearised
                                         ? problem_.linearised_step(state, held, tools, dt_s, {}, limits)
                                         : problem_.step(state, held, tools, dt_s, limits);
    Forces forces;
    std::size_t unilateral = 0, node = specimen_.held.nodes.size();
    for (std::size_t k = 0; k < to.size(); ++k) {
        const ToolSet& set = specimen_.asset.tools[k];
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        std::size_t touched = set.nodes.size();
        if (bonded(set)) {
            for (std::size_t i = 0; i < set.nodes.size(); ++i)
                sum += vec(solution.held_reactions_n[node++]);
        } else {
            const ToolReaction& reaction = solution.tools[unilateral++];
            sum = vec(reaction.force_n);
            touched = static_cast<std::size_t>(
                std::count_if(reaction.touches.begin(), reaction.touches.end(), [](const NodeTouch& touch) {
                    return touch.mode == TouchMode::sticking || touch.mode == TouchMode::sliding;
                }));
        }
        forces.force_n.push_back(sum);
        forces.touched.push_back(touched);
    }
    return forces;
}

Truth::AtRest Truth::at_rest(const Snapshot& at) {
    PrescribedMotion held = specimen_.held;
    std::vector<std::size_t> tool_of(held.nodes.size(), at.tools.size());
    for (std::size_t k = 0; k < at.tools.size(); ++k) {
        const ToolSet& set = specimen_.asset.tools[k];
        std::vector<std::uint32_t> nodes = set.nodes;
        if (!bonded(set)) {
            nodes.clear();
            for (const NodeAt& node : touching(k, at))
                nodes.push_back(set.nodes[node.slot]);
        }
        for (const std::uint32_t node : nodes) {
            const Point &place = at.state.positions_m[node], &home = specimen_.asset.nodes_m[node];
            held.nodes.push_back(node);
            held.displacement_m.push_back({place[0] - home[0], place[1] - home[1], place[2] - home[2]});
            tool_of.push_back(k);
        }
    }
    AtRest found;
    found.force_n.assign(at.tools.size(), Eigen::Vector3d::Zero());
    if (const auto solution = equilibrium_near(held, at, found.refused)) {
        for (std::size_t i = 0; i < held.nodes.size(); ++i)
            if (tool_of[i] < at.tools.size()) found.force_n[tool_of[i]] += vec(solution->reactions_n[i]);
        return found;
    }
    // The forces of the very place, and what is unbalanced there.
    Eigen::VectorXd gradient = body_.gradient_n(flat(at.state.positions_m));
    for (std::size_t i = 0; i < held.nodes.size(); ++i) {
        const Eigen::Index first = first_unknown(held.nodes[i]);
        if (tool_of[i] < at.tools.size()) found.force_n[tool_of[i]] -= gradient.segment<3>(first);
        gradient.segment<3>(first).setZero();
    }
    found.unbalanced_n = gradient.norm();
    return found;
}

std::optional<StaticSolution> Truth::equilibrium_near(const PrescribedMotion& held, const Snapshot& at,
                                                      std::string& refused) {
    NewtonLimits limits;
    limits.relative_residual = kResidual;
    try {
        StaticSolution solution = static_.solve(held, at.state.positions_m, limits);
        const double way_m =
            (flat(solution.positions_m) - flat(at.state.positions_m)).lpNorm<Eigen::Infinity>();
        if (way_m <= kSamePlace * specimen_.size_m) return solution;
    } catch (const ToolError& error) {
        refused = error.what();
    }
    return std::nullopt;
}

}  // namespace knead::tools::stability
