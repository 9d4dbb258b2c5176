// SPDX-License-Identifier: Apache-2.0
#include "core/touched_set.h"

#include <algorithm>
#include <cmath>

namespace knead::core {
namespace {

/// Passing the surface by less than this share of the object's size is rounding.
constexpr Real kGapTolerance = 1e-8;
/// Times that a node may be caught or let go in one step.
constexpr std::uint8_t kMostTouchSwitches = 4;
/// Times that a node may go from slip back to stick in one step. After that it slips by friction that may be
/// less than the most: the updates of the friction find it too, more slowly.
constexpr std::uint8_t kMostGrips = 2;
/// A tool leaves when its way and the way out are within 60 degrees.
constexpr Real kLeaving = 0.5;
/// How stale the reach may be, relative to itself, before it is measured again.
constexpr Real kReachDrift = 0.5;

}  // namespace

TouchedSet::TouchedSet(const ToolSet& tool, std::uint16_t index, const Model& model)
    : surface_(tool),
      kind_(tool.contact),
      friction_coefficient_(tool.contact == ToolContact::coulomb ? tool.friction_coefficient : 0),
      index_(index),
      gap_tolerance_m_(kGapTolerance * model.size_m),
      rest_(model.rest_m) {
    at_rest_.resize(tool.nodes.size());
    for (std::size_t k = 0; k < tool.nodes.size(); ++k) {
        at_rest_[k].node = tool.nodes[k];
        at_rest_[k].mass_kg = model.mass_kg[tool.nodes[k]];
    }
    candidates_ = at_rest_;
    event_m_.resize(candidates_.size());
    journal_.reserve(candidates_.size());
}

void TouchedSet::reset(const Frame& rest) noexcept {
    for (Candidate& candidate : at_rest_) {
        const Vec local = rest.to_local(rest_(candidate.node));
        candidate.beyond = surface_.depth(local) > 0 && surface_.beside(local);
    }
    std::copy(at_rest_.begin(), at_rest_.end(), candidates_.begin());
    journal_.clear();
    std::fill(event_m_.begin(), event_m_.end(), kHeld);
    next_event_m_ = kHeld;
    odometer_m_ = 0;
    frame_ = rest;
    measure_reach(rest, rest_);
    slip_stiffness_.reset();
}

void TouchedSet::measure_reach(const Frame& tool, const NodeReader& positions) noexcept {
    Real squared = 0;
    for (const Candidate& candidate : candidates_)
        squared = std::max(squared, (positions(candidate.node) - tool.position).squaredNorm());
    reach_m_ = std::sqrt(squared);
    reach_drift_m_ = 0;
}

Real TouchedSet::closing(const Frame& tool, Real travel_m) const noexcept {
    return travel_m + (tool.position - frame_.position).norm() +
           (tool.rotation - frame_.rotation).norm() * (reach_m_ + reach_drift_m_);
}

void TouchedSet::save(std::size_t k) noexcept {
    if (candidates_[k].saved) return;
    journal_.push_back({static_cast<std::uint32_t>(k), candidates_[k]});
    candidates_[k].saved = true;
}

void TouchedSet::begin_step(const Frame& tool, const NodeReader& predicted, Real dt_s,
                            Owners& owners) noexcept {
    dt_s_ = dt_s;
    for (const Saved& saved : journal_) {
        Candidate& candidate = candidates_[saved.index];
        candidate.saved = false;
        candidate.touch_switches = candidate.grips = 0;
        candidate.caught_early = candidate.let_go_early = false;
    }
    journal_.clear();
    slip_stiffness_before_ = slip_stiffness_;
    slip_stiffness_.begin_step();
    if (!holds_any()) return;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        if (event_m_[k] != kHeld) continue;
        Candidate& candidate = candidates_[k];
        if (candidate.hold == Hold::open) continue;
        save(k);
        if (candidate.hold != Hold::slip) continue;
        const Vec local = tool.to_local(predicted(candidate.node));
        if (surface_.beside(local)) {  // it slid off the edge
            let_go(k, owners);
            continue;
        }
        candidate.plane = surface_.closest(local);
        // The friction of the step before, laid into the new plane: a start that steady slip needs no change
        // of.
        Vec& friction = candidate.slip.friction_n;
        friction = with_length(in_plane(friction, candidate.plane.outward), friction.norm());
        candidate.slip.compared = candidate.slip.judged = false;
    }
}

void TouchedSet::append_constraints(const Frame& tool, const NodeReader& predicted,
                                    std::vector<Constraint>& constraints) noexcept {
    if (!holds_any()) return;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        if (event_m_[k] != kHeld) continue;
        Candidate& candidate = candidates_[k];
        if (candidate.hold == Hold::open) continue;
        candidate.row = static_cast<std::uint32_t>(constraints.size());
        Constraint constraint;
        constraint.node = candidate.node;
        constraint.tool = index_;
        Vec place = candidate.anchor;
        if (candidate.hold == Hold::slip) {
            const Vec normal = tool.rotation * candidate.plane.outward;
            constraint.held = normal * normal.transpose();
            constraint.friction_n = tool.rotation * candidate.slip.friction_n;
            place = candidate.plane.place;
        }
        constraint.offset_m = tool.to_scene(place) - predicted(candidate.node);
        constraints.push_back(constraint);
    }
}

bool TouchedSet::may_switch(const Candidate& candidate, Tally& tally) const noexcept {
    ++tally.violators;
    if (tally.one_only && tally.touch_changed) return false;
    if (candidate.touch_switches < kMostTouchSwitches) return true;
    tally.given_up = true;
    return false;
}

void TouchedSet::let_go(std::size_t k, Owners& owners) noexcept {
    save(k);
    Candidate& candidate = candidates_[k];
    candidate.hold = Hold::open;
    candidate.slip = {};
    owners[candidate.node] = kNobody;
}

void TouchedSet::judge_held(std::size_t k, const Vec& row_n, const Attempt& attempt, Owners& owners,
                            Tally& tally) noexcept {
    Candidate& candidate = candidates_[k];
    // The object pushes the tool against its outward normal; along it, it would have to be pulled.
    if (candidate.plane.outward.dot(row_n) > attempt.pull_tolerance_n) {
        if (attempt.early) {
            if (candidate.let_go_early) return;
            let_go(k, owners);
            candidate.let_go_early = tally.changed = true;
            return;
        }
        if (!may_switch(candidate, tally)) return;
        let_go(k, owners);
        ++candidate.touch_switches;
        tally.changed = tally.touch_changed = true;
    } else if (kind_ == ToolContact::coulomb && !attempt.early) {
        if (candidate.hold == Hold::stick) {
            judge_stick(candidate, row_n, attempt, tally);
        } else {
            judge_slip(candidate, row_n, attempt, tally);
        }
    }
}

void TouchedSet::judge_stick(Candidate& candidate, const Vec& row_n, const Attempt& attempt,
                             Tally& tally) noexcept {
    const Vec& normal = candidate.plane.outward;
    const Vec grip = -in_plane(row_n, normal);  // what the tool needs to hold the node in its place
    const Real most = friction_coefficient_ * std::max<Real>(0, -normal.dot(row_n));
    if (grip.norm() <= most * (1 + attempt.cone_tolerance) + attempt.pull_tolerance_n) return;
    candidate.hold = Hold::slip;
    candidate.plane = {candidate.anchor, normal};
    candidate.slip.friction_before_n = grip;
    candidate.slip.slip_before_m.setZero();
    candidate.slip.compared = true;
    candidate.slip.friction_n = with_length(grip, most);
    tally.changed = true;
}

void TouchedSet::measure_slip(const Frame& tool, const NodeReader& solved) noexcept {
    slip_stiffness_.begin_pass();
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        Candidate& candidate = candidates_[k];
        if (event_m_[k] != kHeld || candidate.hold != Hold::slip) continue;
        const Vec moved = tool.to_local(solved(candidate.node)) - candidate.anchor;
        candidate.slip.slip_m = in_plane(moved, candidate.plane.outward);
        slip_stiffness_.add(candidate.slip, dt_s_ * dt_s_ / candidate.mass_kg);
    }
    slip_stiffness_.finish_pass();
}

void TouchedSet::judge_slip(Candidate& candidate, const Vec& row_n, const Attempt& attempt,
                            Tally& tally) noexcept {
    const Real most = friction_coefficient_ * std::max<Real>(0, -candidate.plane.outward.dot(row_n));
    const Real stiffness = slip_stiffness_.factor() * candidate.mass_kg / (dt_s_ * dt_s_);
    Slip& slip = candidate.slip;
    bool holds = false;
    slip.wanted_n = friction_of(slip, stiffness, most, holds);
    if (holds && candidate.grips < kMostGrips) {
        ++candidate.grips;
        candidate.hold = Hold::stick;
        candidate.plane = surface_.closest(candidate.anchor);
        candidate.slip = {};
        tally.changed = true;
        return;
    }
    const Real tolerance = attempt.cone_tolerance * most + attempt.pull_tolerance_n;
    slip.judged = tally.friction_may_change;
    if ((slip.wanted_n - slip.friction_n).squaredNorm() <= tolerance * tolerance) return;
    if (!tally.friction_may_change) {
        tally.given_up = true;
        return;
    }
    tally.changed = tally.friction_changed = true;
}

void TouchedSet::judge_open(std::size_t k, const Frame& tool, const Attempt& attempt, Owners& owners,
                            Tally& tally) noexcept {
    Candidate& candidate = candidates_[k];
    if (candidate.beyond || owners[candidate.node] != kNobody) return;
    const Vec local = tool.to_local(attempt.solved(candidate.node));
    if (surface_.depth(local) <= gap_tolerance_m_ || surface_.beside(local)) return;
    if (attempt.early) {
        // A tool that sticks takes hold of the place where a node comes: that must be a solved one.
        if (kind_ != ToolContact::frictionless || candidate.caught_early) return;
        catch_node(k, local, owners);
        candidate.caught_early = true;
        tally.changed = true;
        return;
    }
    if (!may_switch(candidate, tally)) return;
    catch_node(k, local, owners);
    ++candidate.touch_switches;
    tally.changed = tally.touch_changed = true;
}

void TouchedSet::catch_node(std::size_t k, const Vec& local, Owners& owners) noexcept {
    save(k);
    Candidate& candidate = candidates_[k];
    candidate.plane = surface_.closest(local);
    candidate.anchor = candidate.plane.place;
    candidate.hold = kind_ == ToolContact::frictionless ? Hold::slip : Hold::stick;
    owners[candidate.node] = index_;
    event_m_[k] = next_event_m_ = kHeld;
}

void TouchedSet::revise(const Frame& tool, const Attempt& attempt, Owners& owners, Tally& tally) noexcept {
    const Real limit = odometer_m_ + closing(tool, attempt.travel_m);
    if (next_event_m_ > limit) return;
    if (kind_ == ToolContact::coulomb && holds_any() && !attempt.early) measure_slip(tool, attempt.solved);
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        if (event_m_[k] > limit) continue;
        const Candidate& candidate = candidates_[k];
        if (candidate.hold == Hold::open) {
            judge_open(k, tool, attempt, owners, tally);
        } else {
            judge_held(k, tool.rotation.transpose() * attempt.row_n[candidate.row], attempt, owners, tally);
        }
    }
}

void TouchedSet::take_friction() noexcept {
    if (kind_ != ToolContact::coulomb || !holds_any()) return;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        if (event_m_[k] == kHeld) candidates_[k].slip.take_wanted();
    }
}

void TouchedSet::yield_to_pull(const Frame& tool, const Attempt& attempt, Tally& tally) noexcept {
    if (kind_ != ToolContact::sticking || surface_.flat() || !holds_any()) return;
    Vec inward = Vec::Zero();
    Vec force = Vec::Zero();
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        if (event_m_[k] != kHeld || candidates_[k].hold == Hold::open) continue;
        inward -= tool.rotation * candidates_[k].plane.outward;
        force += attempt.row_n[candidates_[k].row];
    }
    slide_what_pulls(inward, force, attempt, tally);
    const Vec way = tool.position - frame_.position;
    if (way.dot(inward) > kLeaving * way.norm() * inward.norm()) slide_what_pulls(way, force, attempt, tally);
}

void TouchedSet::slide_what_pulls(const Vec& way, const Vec& force_n, const Attempt& attempt,
                                  Tally& tally) noexcept {
    if (!(force_n.dot(way) < -attempt.pull_tolerance_n * way.norm())) return;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        Candidate& candidate = candidates_[k];
        if (event_m_[k] != kHeld || candidate.hold != Hold::stick) continue;
        if (attempt.row_n[candidate.row].dot(way) >= 0) continue;
        candidate.hold = Hold::slip;  // back to stick at the end of the step, in another place
        candidate.plane.place = candidate.anchor;
        tally.changed = true;
    }
}

void TouchedSet::end_step(const Frame& tool, const NodeReader& positions, Real travel_m) noexcept {
    const Real closed = closing(tool, travel_m);
    reach_drift_m_ += travel_m + (tool.position - frame_.position).norm();
    frame_ = tool;
    if (std::isfinite(closed)) {
        odometer_m_ += closed;
    } else {
        std::fill(event_m_.begin(), event_m_.end(), kHeld);
        next_event_m_ = kHeld;
    }
    if (!(reach_drift_m_ <= kReachDrift * reach_m_)) measure_reach(tool, positions);
    if (next_event_m_ > odometer_m_) return;
    next_event_m_ = std::numeric_limits<Real>::infinity();
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        if (event_m_[k] <= odometer_m_) {
            Candidate& candidate = candidates_[k];
            const Vec local = tool.to_local(positions(candidate.node));
            if (candidate.hold == Hold::open) {
                const Real depth = surface_.depth(local);
                if (depth <= 0) {
                    candidate.beyond = false;
                } else if (surface_.beside(local)) {
                    candidate.beyond = true;
                }
                event_m_[k] = odometer_m_ + std::abs(depth);
            } else if (candidate.hold == Hold::slip) {
                candidate.plane = surface_.closest(local);
                candidate.anchor = candidate.plane.place;
                if (kind_ == ToolContact::sticking) candidate.hold = Hold::stick;
            }
        }
        next_event_m_ = std::min(next_event_m_, event_m_[k]);
    }
}

void TouchedSet::abandon_step(Owners& owners) noexcept {
    for (const Saved& saved : journal_) {
        std::uint16_t& owner = owners[saved.before.node];
        if (saved.before.hold != Hold::open) {
            owner = index_;
        } else if (owner == index_) {
            owner = kNobody;
        }
        candidates_[saved.index] = saved.before;
        event_m_[saved.index] = next_event_m_ = kHeld;
    }
    journal_.clear();
    slip_stiffness_ = slip_stiffness_before_;
}

}  // namespace knead::core
