// SPDX-License-Identifier: Apache-2.0
#include "core/contact.h"

#include <cmath>

namespace knead::core {
namespace {

/// Passing the surface by less than this share of the object's size is rounding.
constexpr Real kGapTolerance = 1e-8;

}  // namespace

Contact::Contact(const ToolSet& tool, const Model& model)
    : shape_(tool.shape),
      kind_(tool.contact),
      radius_m_(tool.radius_m),
      half_extents_m_{Real(tool.half_extents_m[0]), Real(tool.half_extents_m[1])},
      gap_tolerance_m_(kGapTolerance * model.size_m) {
    const auto& p = tool.rest_position_m;
    const auto& q = tool.rest_orientation_wxyz;
    rest_frame_.position = Vec(p[0], p[1], p[2]);
    rest_frame_.rotation = Quat(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    at_rest_.resize(tool.nodes.size());
    for (std::size_t k = 0; k < tool.nodes.size(); ++k) {
        Candidate& candidate = at_rest_[k];
        candidate.node = tool.nodes[k];
        const Vec local = rest_frame_.to_local(model.rest_m[candidate.node]);
        if (kind_ == ToolContact::bonded) {
            candidate.held = true;
            candidate.anchor = local;
        } else {
            candidate.beyond = depth(local) > 0 && beside(local);
        }
    }
    candidates_ = before_ = at_rest_;
    constraints_.reserve(at_rest_.size());
    candidate_of_.reserve(at_rest_.size());
}

void Contact::reset() noexcept {
    candidates_ = at_rest_;
    before_ = at_rest_;
    constraints_.clear();
    candidate_of_.clear();
}

/// How far a point is inside the tool (sphere) or behind its face (plate); negative: outside.
Real Contact::depth(const Vec& local) const noexcept {
    return shape_ == ToolShape::sphere ? radius_m_ - local.norm() : local.z();
}

/// Past the rectangle of a bounded plate, whose side walls do not touch.
bool Contact::beside(const Vec& local) const noexcept {
    if (shape_ == ToolShape::sphere || (half_extents_m_[0] == 0 && half_extents_m_[1] == 0)) return false;
    return std::abs(local.x()) > half_extents_m_[0] || std::abs(local.y()) > half_extents_m_[1];
}

void Contact::place_on_surface(Candidate& candidate, const Vec& local) const noexcept {
    if (shape_ == ToolShape::plate) {
        candidate.normal = Vec(0, 0, -1);
        candidate.anchor = Vec(local.x(), local.y(), 0);
        return;
    }
    const Real distance = local.norm();
    candidate.normal = distance > 0 ? Vec(local / distance) : Vec(0, 0, 1);
    candidate.anchor = radius_m_ * candidate.normal;
}

void Contact::list_constraints(const Frame& tool, const Field& predicted_m) noexcept {
    constraints_.clear();
    candidate_of_.clear();
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        const Candidate& candidate = candidates_[k];
        if (!candidate.held) continue;
        Constraint constraint;
        constraint.node = candidate.node;
        if (kind_ == ToolContact::frictionless) {
            const Vec normal = tool.rotation * candidate.normal;
            constraint.held = normal * normal.transpose();
        }
        constraint.offset_m = tool.to_scene(candidate.anchor) - predicted_m[candidate.node];
        constraints_.push_back(constraint);
        candidate_of_.push_back(k);
    }
}

void Contact::begin_step(const Frame& tool, const Field& predicted_m) noexcept {
    before_ = candidates_;
    for (Candidate& candidate : candidates_) {
        candidate.caught = candidate.let_go = false;
        if (!candidate.held || kind_ != ToolContact::frictionless) continue;
        const Vec local = tool.to_local(predicted_m[candidate.node]);
        if (beside(local)) {
            candidate.held = false;  // it slid off the edge
        } else {
            place_on_surface(candidate, local);
        }
    }
    list_constraints(tool, predicted_m);
}

bool Contact::revise(const Frame& tool, const Field& predicted_m, const Solution& solution,
                     Real pull_tolerance_n) noexcept {
    if (kind_ == ToolContact::bonded) return false;
    bool changed = false;
    for (std::size_t k = 0; k < constraints_.size(); ++k) {
        Candidate& candidate = candidates_[candidate_of_[k]];
        const Vec outward = tool.rotation * candidate.normal;
        // The object pushes the tool against its outward normal; along it, it would have to be pulled.
        if (candidate.let_go || outward.dot(solution.reaction_n[k]) <= pull_tolerance_n) continue;
        candidate.held = false;
        candidate.let_go = true;
        changed = true;
    }
    Frame moved = tool;
    moved.position += solution.displacement.tool;
    for (Candidate& candidate : candidates_) {
        if (candidate.held || candidate.caught || candidate.let_go || candidate.beyond) continue;
        const Vec local =
            moved.to_local(predicted_m[candidate.node] + solution.displacement.nodes[candidate.node]);
        if (depth(local) <= gap_tolerance_m_ || beside(local)) continue;
        place_on_surface(candidate, local);
        candidate.held = true;
        candidate.caught = true;
        changed = true;
    }
    if (changed) list_constraints(tool, predicted_m);
    return changed;
}

void Contact::end_step(const Frame& tool, const Field& positions_m) noexcept {
    for (Candidate& candidate : candidates_) {
        if (candidate.held) continue;
        const Vec local = tool.to_local(positions_m[candidate.node]);
        if (depth(local) <= 0) {
            candidate.beyond = false;
        } else if (beside(local)) {
            candidate.beyond = true;
        }
    }
}

}  // namespace knead::core
