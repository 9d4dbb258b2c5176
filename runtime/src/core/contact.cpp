// SPDX-License-Identifier: Apache-2.0
#include "core/contact.h"

#include <algorithm>

namespace knead::core {
namespace {

/// Passes in which the violators may fail to become fewer before nodes switch one at a time.
constexpr int kPatience = 2;

Frame rest_frame_of(const ToolSet& tool) {
    const auto& p = tool.rest_position_m;
    const auto& q = tool.rest_orientation_wxyz;
    return {Vec(p[0], p[1], p[2]), Quat(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix()};
}

}  // namespace

Contact::Contact(const std::vector<ToolSet>& tools, const Model& model, BondedNodes bonded_nodes)
    : bonded_nodes_(bonded_nodes),
      bonded_owners_(model.rest_m.size(), kNobody),
      owners_(model.rest_m.size(), kNobody),
      loads_(tools.size()),
      predicted_(tools.size()) {
    std::size_t most = 0;
    for (std::size_t t = 0; t < tools.size(); ++t) {
        Tool tool;
        tool.rest = rest_frame_of(tools[t]);
        const auto index = static_cast<std::uint16_t>(t);
        if (tools[t].contact != ToolContact::bonded) {
            tool.touched.emplace_back(tools[t], index, model);
        } else {
            for (const std::uint32_t node : tools[t].nodes) {
                if (bonded_owners_[node] != kNobody) continue;
                bonded_owners_[node] = index;
                tool.bonds.push_back({node, tool.rest.to_local(model.rest_m[node])});
            }
        }
        tools_.push_back(std::move(tool));
        most += tools[t].nodes.size();
    }
    constraints_.reserve(std::min<std::size_t>(most, model.free_count));
    reset();
}

void Contact::reset() noexcept {
    for (Tool& tool : tools_) {
        for (TouchedSet& touched : tool.touched)
            touched.reset(tool.rest);
    }
    std::copy(bonded_owners_.begin(), bonded_owners_.end(), owners_.begin());
    constraints_.clear();
    std::fill(loads_.begin(), loads_.end(), ToolLoad{});
}

void Contact::list_constraints(const NodeReader& predicted) noexcept {
    constraints_.clear();
    for (std::size_t t = 0; t < tools_.size(); ++t) {
        if (bonded_nodes_ == BondedNodes::left_out) break;
        for (const Bond& bond : tools_[t].bonds) {
            Constraint constraint;
            constraint.node = bond.node;
            constraint.tool = static_cast<std::uint32_t>(t);
            constraint.offset_m = predicted_[t].to_scene(bond.anchor) - predicted(bond.node);
            constraints_.push_back(constraint);
        }
    }
    for (std::size_t t = 0; t < tools_.size(); ++t) {
        for (TouchedSet& touched : tools_[t].touched)
            touched.append_constraints(predicted_[t], predicted, constraints_);
    }
}

void Contact::begin_step(const std::vector<Frame>& tools, const NodeReader& predicted, Real dt_s) noexcept {
    std::copy(tools.begin(), tools.end(), predicted_.begin());
    friction_updates_ = 0;
    fewest_violators_ = owners_.size() + 1;
    passes_without_gain_ = early_changes_ = 0;
    for (std::size_t t = 0; t < tools_.size(); ++t) {
        for (TouchedSet& touched : tools_[t].touched)
            touched.begin_step(predicted_[t], predicted, dt_s, owners_);
    }
    list_constraints(predicted);
}

void Contact::predict_again(const std::vector<Frame>& tools, const NodeReader& predicted) noexcept {
    std::copy(tools.begin(), tools.end(), predicted_.begin());
    list_constraints(predicted);
}

Frame Contact::moved(std::size_t tool, const Attempt& attempt) const noexcept {
    return {predicted_[tool].position + attempt.tool_displacement_m[tool], predicted_[tool].rotation};
}

void Contact::measure(const Attempt& attempt) noexcept {
    std::fill(loads_.begin(), loads_.end(), ToolLoad{});
    for (std::size_t k = 0; k < constraints_.size(); ++k) {
        const Constraint& constraint = constraints_[k];
        const Vec force = force_on_tool(constraint, attempt.row_n[k]);
        const Vec origin =
            predicted_[constraint.tool].position + attempt.tool_displacement_m[constraint.tool];
        ToolLoad& load = loads_[constraint.tool];
        load.force_n += force;
        load.torque_n_m += (attempt.solved(constraint.node) - origin).cross(force);
        ++load.touched;
    }
}

bool Contact::glance(const Attempt& attempt) noexcept {
    if (early_changes_ >= kMostEarlyChanges || passes_without_gain_ >= kPatience) return false;
    Tally tally;
    for (std::size_t t = 0; t < tools_.size(); ++t) {
        for (TouchedSet& touched : tools_[t].touched)
            touched.revise(moved(t, attempt), attempt, owners_, tally);
    }
    if (!tally.changed) return false;
    ++early_changes_;
    list_constraints(attempt.predicted);
    return true;
}

Contact::Revision Contact::revise(const Attempt& attempt) noexcept {
    measure(attempt);
    Tally tally;
    tally.one_only = passes_without_gain_ >= kPatience;
    tally.friction_may_change = friction_updates_ < kMostFrictionUpdates;
    for (std::size_t t = 0; t < tools_.size(); ++t) {
        for (TouchedSet& touched : tools_[t].touched)
            touched.revise(moved(t, attempt), attempt, owners_, tally);
    }
    for (std::size_t t = 0; t < tools_.size() && !tally.changed; ++t) {
        for (TouchedSet& touched : tools_[t].touched)
            touched.yield_to_pull(moved(t, attempt), attempt, tally);
    }
    if (!tally.changed) return tally.given_up ? Revision::given_up : Revision::settled;
    if (tally.friction_changed) ++friction_updates_;
    for (Tool& tool : tools_) {
        for (TouchedSet& touched : tool.touched)
            touched.take_friction();
    }
    if (tally.violators < fewest_violators_) {
        fewest_violators_ = tally.violators;
        passes_without_gain_ = 0;
    } else if (tally.violators > 0) {
        ++passes_without_gain_;
    }
    list_constraints(attempt.predicted);
    return Revision::changed;
}

void Contact::end_step(const std::vector<Frame>& tools, const NodeReader& positions, Real travel_m) noexcept {
    for (std::size_t t = 0; t < tools_.size(); ++t) {
        for (TouchedSet& touched : tools_[t].touched)
            touched.end_step(tools[t], positions, travel_m);
    }
}

void Contact::abandon_step() noexcept {
    for (Tool& tool : tools_) {
        for (TouchedSet& touched : tool.touched)
            touched.abandon_step(owners_);
    }
}

}  // namespace knead::core
