// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "core/constraint.h"
#include "core/friction.h"
#include "core/model.h"
#include "core/node_reader.h"
#include "core/tool_surface.h"

namespace knead::core {

/// Which tool holds a node; at most one at a time. [nodes]
using Owners = std::vector<std::uint16_t>;
inline constexpr std::uint16_t kNobody = std::numeric_limits<std::uint16_t>::max();

/// How a node stands to a tool.
enum class Hold : std::uint8_t {
    open,   ///< not held
    stick,  ///< held at its anchor
    slip    ///< held along the normal only, moving over the surface against its friction
};

/// A node that the tool may touch. Vectors in the tool's frame.
struct Candidate {
    std::uint32_t node = 0;
    Hold hold = Hold::open;
    bool beyond = false;              ///< behind the plate's plane, but it went there beside the rectangle
    bool saved = false;               ///< its state from before the step is in the journal
    std::uint8_t touch_switches = 0;  ///< in this step: caught or let go
    std::uint8_t grips = 0;           ///< in this step: from slip back to stick
    bool caught_early = false;        ///< in this step, by an early look
    bool let_go_early = false;        ///< the same
    std::uint32_t row = 0;            ///< its constraint while it is held
    Real mass_kg = 0;
    Vec anchor = Vec::Zero();  ///< the tool's place it was at when the step began, or where it came since
    SurfacePoint plane;        ///< the normal, and where a slipping node is held along it
    Slip slip;
};

/// What a solve found for the tools, and how exactly.
struct Attempt {
    NodeReader predicted;                         ///< what constraints are relative to
    NodeReader solved;                            ///< where the nodes are now
    const std::vector<Vec>& tool_displacement_m;  ///< [tools] beyond the prediction; zero unless coupled
    const std::vector<Vec>& row_n;                ///< [constraints] of the held nodes, as in force_on_tool()
    Real travel_m = 0;                            ///< no node has moved farther since the step before
    Real pull_tolerance_n = 0;                    ///< a pull of a node up to this is the solver's error
    Real cone_tolerance = 0;  ///< of a slipping node's friction, relative to what Coulomb's law says
    /// The solve is not at its end: only changes of touch are wanted, of a node one each way.
    bool early = false;
};

/// What all tools together find in one revision.
struct Tally {
    bool one_only = false;            ///< switch the first violator only
    bool friction_may_change = true;  ///< false: the step's share of friction updates is used up
    std::size_t violators = 0;        ///< nodes to be caught or let go
    bool changed = false;             ///< another solve is due
    bool touch_changed = false;       ///< a violator has switched
    bool friction_changed = false;
    bool given_up = false;  ///< a node is wrong and may not switch any more in this step
};

/// The nodes that one unilateral tool touches: an active set, starting from that of the step before.
///
/// A node that would pass the surface is held on it, and let go when it would have to be pulled. Sticking: at
/// the place where it came. Frictionless: along the normal only, the tangent plane taken anew each step.
/// Coulomb: at its place up to friction_coefficient times the normal force, then along the normal with that
/// friction as a load. A node switches a bounded number of times in a step. Allocates in the constructor
/// only.
class TouchedSet {
  public:
    /// @param tool valid, unilateral  @param index of the tool  @param model outlives this
    TouchedSet(const ToolSet& tool, std::uint16_t index, const Model& model);

    void reset(const Frame& rest) noexcept;

    /// @param tool predicted
    void begin_step(const Frame& tool, const NodeReader& predicted, Real dt_s, Owners& owners) noexcept;

    void append_constraints(const Frame& tool, const NodeReader& predicted,
                            std::vector<Constraint>& constraints) noexcept;

    /// Lets go of what would be pulled, catches what would pass, finds the friction of what slips.
    /// @param tool predicted and displaced
    void revise(const Frame& tool, const Attempt& attempt, Owners& owners, Tally& tally) noexcept;

    /// The friction that revise() found, because another solve is due.
    void take_friction() noexcept;

    /// A curved tool that sticks and would be pulled as a whole (against the mean of its normals, or against
    /// its way while it leaves), by nodes that push along their own normals but pull sideways: lets those
    /// slide for this step. To be asked when revise() found nothing.
    void yield_to_pull(const Frame& tool, const Attempt& attempt, Tally& tally) noexcept;

    /// @param tool where it is now  @param travel_m as in Attempt
    void end_step(const Frame& tool, const NodeReader& positions, Real travel_m) noexcept;

    void abandon_step(Owners& owners) noexcept;

    [[nodiscard]] std::size_t size() const noexcept { return candidates_.size(); }

  private:
    struct Saved {
        std::uint32_t index = 0;
        Candidate before;
    };

    void judge_held(std::size_t k, const Vec& row_n, const Attempt& attempt, Owners& owners,
                    Tally& tally) noexcept;
    void judge_open(std::size_t k, const Frame& tool, const Attempt& attempt, Owners& owners,
                    Tally& tally) noexcept;
    void judge_stick(Candidate& candidate, const Vec& row_n, const Attempt& attempt, Tally& tally) noexcept;
    void slide_what_pulls(const Vec& way, const Vec& force_n, const Attempt& attempt, Tally& tally) noexcept;
    void measure_slip(const Frame& tool, const NodeReader& solved) noexcept;
    void judge_slip(Candidate& candidate, const Vec& row_n, const Attempt& attempt, Tally& tally) noexcept;
    void catch_node(std::size_t k, const Vec& local, Owners& owners) noexcept;
    [[nodiscard]] bool may_switch(const Candidate& candidate, Tally& tally) const noexcept;
    void let_go(std::size_t k, Owners& owners) noexcept;
    void save(std::size_t k) noexcept;
    [[nodiscard]] bool holds_any() const noexcept { return next_event_m_ == kHeld; }
    /// By how much the gap of a node may have closed since the step before.
    [[nodiscard]] Real closing(const Frame& tool, Real travel_m) const noexcept;
    void measure_reach(const Frame& tool, const NodeReader& positions) noexcept;

    static constexpr Real kHeld = -std::numeric_limits<Real>::infinity();

    ToolSurface surface_;
    ToolContact kind_;
    Real friction_coefficient_;
    std::uint16_t index_;
    Real gap_tolerance_m_;
    NodeReader rest_;

    std::vector<Candidate> at_rest_, candidates_;
    std::vector<Saved> journal_;  ///< what this step has changed

    // Far nodes cost nothing: all gaps together have closed by at most odometer_m_ since the start, and
    // nothing can happen to candidate k before that passes event_m_[k]. kHeld: look every time.
    std::vector<Real> event_m_;  ///< [candidates]
    Real next_event_m_ = kHeld;  ///< the least of event_m_
    Real odometer_m_ = 0;
    Frame frame_;                           ///< at the end of the step before
    Real reach_m_ = 0, reach_drift_m_ = 0;  ///< farthest candidate from the tool's origin, and how stale

    Real dt_s_ = 0;
    SlipStiffness slip_stiffness_, slip_stiffness_before_;
};

}  // namespace knead::core
