// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/contact_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/error.h"
#include "reference/elastic_body.h"

namespace knead::tools {
namespace {

Eigen::Vector3d place(const Candidate& candidate, const Eigen::VectorXd& positions_m) {
    return positions_m.segment<3>(first_unknown(candidate.node));
}

double friction_of(const ContactTool& tool) {
    if (tool.law == ToolContact::frictionless) return 0;
    if (tool.law != ToolContact::coulomb) return std::numeric_limits<double>::infinity();
    if (!std::isfinite(tool.friction_coefficient) || tool.friction_coefficient < 0)
        fail_input(fmt::format("contact tool: friction coefficient {} is not finite and >= 0",
                               tool.friction_coefficient));
    return tool.friction_coefficient;
}

void check_lists(const ContactTool& tool, std::size_t node_count) {
    if (!tool.before.empty() && tool.before.size() != tool.nodes.size())
        fail_input(fmt::format("contact tool: {} states from the step before for {} nodes",
                               tool.before.size(), tool.nodes.size()));
    std::vector<std::uint32_t> sorted = tool.nodes;
    std::sort(sorted.begin(), sorted.end());
    if (!sorted.empty() && sorted.back() >= node_count)
        fail_input(fmt::format("contact tool: node {} of {} does not exist", sorted.back(), node_count));
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) fail_input(fmt::format("contact tool: node {} is given twice", *twice));
}

NodeTouch before_of(const ContactTool& tool, std::size_t slot) {
    const NodeTouch touch = tool.before.empty() ? NodeTouch{} : tool.before[slot];
    if (tool.law == ToolContact::bonded && touch.mode != TouchMode::sticking)
        fail_input(fmt::format("contact tool: node {} of a bonded tool has no anchor", tool.nodes[slot]));
    return touch;
}

}  // namespace

ContactSet::ContactSet(const std::vector<ContactTool>& tools, const std::vector<bool>& is_prescribed,
                       Eigen::VectorXd start_m, Eigen::VectorXd predicted_m, bool planes_stay)
    : start_(std::move(start_m)), predicted_(std::move(predicted_m)), planes_stay_(planes_stay) {
    for (const ContactTool& tool : tools)
        add_tool(tool, is_prescribed);
    for (const Candidate& candidate : candidates_)
        if (candidate.touching) refuse_second_tool(candidate);
}

void ContactSet::add_tool(const ContactTool& tool, const std::vector<bool>& is_prescribed) {
    check_lists(tool, is_prescribed.size() / 3);
    const std::size_t index = surfaces_.size();
    surfaces_.emplace_back(tool);
    ContactTool earlier = tool;
    earlier.pose = tool.pose_before;
    surfaces_before_.emplace_back(earlier);
    catch_places_.push_back(tool.catch_place);
    const double friction = friction_of(tool);
    for (std::size_t slot = 0; slot < tool.nodes.size(); ++slot) {
        const std::uint32_t node = tool.nodes[slot];
        const int held = is_prescribed[3 * std::size_t{node}] + is_prescribed[3 * std::size_t{node} + 1] +
                         is_prescribed[3 * std::size_t{node} + 2];
        if (held == 3) continue;
        if (held != 0) fail_input(fmt::format("contact tool: node {} is held along {} axes", node, held));
        const NodeTouch before = before_of(tool, slot);
        Candidate candidate;
        candidate.tool = index;
        candidate.slot = slot;
        candidate.node = node;
        candidate.law = {tool.law == ToolContact::bonded, friction};
        candidate.keeps_anchor = std::isinf(friction);
        candidate.ignored = before.mode == TouchMode::beside;
        candidate.known = candidate.touching =
            before.mode == TouchMode::sticking || before.mode == TouchMode::sliding;
        candidate.stuck_before = before.mode == TouchMode::sticking;
        if (candidate.known) {
            const Eigen::Vector3d anchor(before.anchor_m.data());
            if (!anchor.allFinite())
                fail_input(fmt::format("contact tool: the anchor of node {} is not finite", node));
            candidate.anchor_m = surfaces_.back().to_scene(anchor);
        }
        candidates_.push_back(candidate);
    }
}

void ContactSet::take_plane(Candidate& candidate, const Eigen::Vector3d& place_m) const {
    const ToolSurface& surface = surfaces_[candidate.tool];
    const bool at_anchor = candidate.keeps_anchor || (planes_stay_ && candidate.stuck_before);
    const Eigen::Vector3d where = at_anchor ? candidate.anchor_m : place_m;
    const SurfacePoint point = surface.nearest(surface.to_local(where));
    candidate.frame = frame_along(surface.rotation() * point.normal);
    candidate.foot_m = at_anchor ? candidate.anchor_m : surface.to_scene(point.foot_m);
    candidate.has_plane = true;
}

void ContactSet::take_planes(const Eigen::VectorXd& positions_m) {
    for (Candidate& candidate : candidates_)
        if (candidate.known && !(planes_stay_ && candidate.has_plane))
            take_plane(candidate, place(candidate, positions_m));
}

void ContactSet::catch_node(Candidate& candidate, const Eigen::Vector3d& place_m) {
    refuse_second_tool(candidate);
    const ToolSurface& surface = surfaces_[candidate.tool];
    Eigen::Vector3d local = surface.to_local(place_m);
    switch (catch_places_[candidate.tool]) {
        case CatchPlace::predicted:
            local = surface.to_local(place(candidate, predicted_));
            break;
        case CatchPlace::on_the_tool_before:
            local = surfaces_before_[candidate.tool].to_local(place(candidate, start_));
            break;
        case CatchPlace::solved_without_it:
            break;
    }
    candidate.anchor_m = surface.to_scene(surface.nearest(local).foot_m);
    candidate.known = true;
    take_plane(candidate, place_m);
}

void ContactSet::refuse_second_tool(const Candidate& candidate) const {
    for (const Candidate& other : candidates_)
        if (other.node == candidate.node && other.tool != candidate.tool && other.touching)
            fail_result(fmt::format("node {} touches two tools at once", candidate.node));
}

bool ContactSet::find_new(const Eigen::VectorXd& positions_m, double tolerance_m) {
    bool changed = false;
    for (Candidate& candidate : candidates_) {
        if (candidate.ignored) continue;
        const ToolSurface& surface = surfaces_[candidate.tool];
        const Eigen::Vector3d now = place(candidate, positions_m);
        const Eigen::Vector3d local = surface.to_local(now);
        const bool beyond = surface.nearest(local).gap_m < -tolerance_m;
        if (candidate.known) {
            const bool slid_off = candidate.touching && !candidate.keeps_anchor && surface.beside(local);
            if (!slid_off) continue;
            candidate.known = candidate.touching = candidate.slipping = false;
            candidate.force_n.setZero();
            candidate.ignored = true;
            changed = true;
        } else if (beyond && surface.beside(local)) {
            candidate.ignored = true;
        } else if (beyond) {
            catch_node(candidate, now);
            changed = true;
        }
    }
    return changed;
}

void ContactSet::put_on_surface(Eigen::VectorXd& positions_m) const {
    for (const Candidate& candidate : candidates_) {
        if (!candidate.touching) continue;
        const ToolSurface& surface = surfaces_[candidate.tool];
        auto position = positions_m.segment<3>(first_unknown(candidate.node));
        const bool stuck = candidate.keeps_anchor || (candidate.law.friction > 0 && !candidate.slipping);
        position =
            stuck ? candidate.anchor_m : surface.to_scene(surface.nearest(surface.to_local(position)).foot_m);
    }
}

double ContactSet::gap_m(const Candidate& candidate, const Eigen::VectorXd& positions_m) const {
    const ToolSurface& surface = surfaces_[candidate.tool];
    return surface.nearest(surface.to_local(place(candidate, positions_m))).gap_m;
}

double ContactSet::violation_m(const Candidate& candidate, const Eigen::VectorXd& positions_m) const {
    const bool stuck =
        candidate.touching && (candidate.keeps_anchor || (candidate.law.friction > 0 && !candidate.slipping));
    if (stuck) return (place(candidate, positions_m) - candidate.anchor_m).norm();
    const ToolSurface& surface = surfaces_[candidate.tool];
    if (candidate.ignored || surface.beside(surface.to_local(place(candidate, positions_m)))) return 0;
    return std::max(0.0, -gap_m(candidate, positions_m));
}

NodeTouch ContactSet::touch(const Candidate& candidate, const Eigen::VectorXd& positions_m) const {
    const ToolSurface& surface = surfaces_[candidate.tool];
    const Eigen::Vector3d local = surface.to_local(place(candidate, positions_m));
    NodeTouch result;
    if (candidate.touching) {
        const bool stuck = candidate.law.friction > 0 && !candidate.slipping;
        const Eigen::Vector3d anchor =
            stuck ? surface.to_local(candidate.anchor_m) : surface.nearest(local).foot_m;
        result.mode = stuck ? TouchMode::sticking : TouchMode::sliding;
        result.anchor_m = {anchor.x(), anchor.y(), anchor.z()};
    } else if (surface.nearest(local).gap_m < 0 && (candidate.ignored || surface.beside(local))) {
        result.mode = TouchMode::beside;
    }
    return result;
}

}  // namespace knead::tools
