// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/touched_set.h"

namespace knead::core {

/// A node of a bonded tool.
struct Bond {
    std::uint32_t node = 0;
    Vec anchor = Vec::Zero();  ///< in the tool's frame
};

/// What the object does to a tool through the nodes in the constraint list.
struct ToolLoad {
    Vec force_n = Vec::Zero();     ///< on the tool
    Vec torque_n_m = Vec::Zero();  ///< about the tool's origin, scene axes
    std::uint32_t touched = 0;     ///< nodes held
};

enum class BondedNodes : std::uint8_t {
    listed,   ///< constraints like all others
    left_out  ///< not in constraints(): the core moves them itself, see bonds()
};

/// Which nodes the tools hold, and how: hard constraints by active sets that start from the step before.
///
/// Bonded tools: all their nodes, always, rigidly. Others: TouchedSet. A node is held by one tool at a time:
/// the one that had it first, of several in one pass the one listed first; nodes of a bonded tool are never
/// free for others. Passes end: a node may switch a few times only in a step (touched_set.cpp), friction is
/// updated kMostFrictionUpdates times, and when the violations stop becoming fewer, only one node switches
/// at a time (Judice and Pires 1994). No penalty forces. Allocates in the constructor only.
///
/// One step: begin_step(); solve; revise(), solve again while it says changed; end_step() or abandon_step().
class Contact {
  public:
    enum class Revision : std::uint8_t {
        settled,  ///< no node inside a tool, none pulled, friction as Coulomb's law says, within tolerance
        changed,  ///< solve again
        given_up  ///< a node is still wrong and has used up its switches: not settled, go on with the step
    };

    static constexpr int kMostFrictionUpdates = 30;  ///< passes of a step
    static constexpr int kMostEarlyChanges = 10;     ///< times that glance() may change something in a step

    /// @param tools valid, of the asset that `model` was built from  @param model outlives this
    Contact(const std::vector<ToolSet>& tools, const Model& model,
            BondedNodes bonded_nodes = BondedNodes::listed);

    void reset() noexcept;

    /// The touched sets of the step before. @param tools [tools] predicted
    void begin_step(const std::vector<Frame>& tools, const NodeReader& predicted, Real dt_s) noexcept;

    /// Another prediction of the same step: nothing changes but what constraints are relative to.
    void predict_again(const std::vector<Frame>& tools, const NodeReader& predicted) noexcept;

    /// What the tools feel in a solve with constraints(): load(). Part of revise(); for a solve that failed.
    void measure(const Attempt& attempt) noexcept;

    /// After a solve with constraints().
    Revision revise(const Attempt& attempt) noexcept;

    /// After an iteration of a solve with constraints() that is not at its end. A clear change of touch is
    /// taken over at once: the solve need not be finished for a set that is wrong. Changes nothing of what a
    /// step ends with but its way there; mistakes are mended by revise().
    /// @param attempt early  @return whether something has changed: solve again
    bool glance(const Attempt& attempt) noexcept;

    /// After an accepted step. @param tools [tools] where they are now  @param travel_m as in Attempt
    void end_step(const std::vector<Frame>& tools, const NodeReader& positions, Real travel_m) noexcept;

    /// Back to before begin_step().
    void abandon_step() noexcept;

    /// Bonded nodes first (if listed), then by tool, then by node.
    [[nodiscard]] const std::vector<Constraint>& constraints() const noexcept { return constraints_; }
    [[nodiscard]] std::size_t max_constraints() const noexcept { return constraints_.capacity(); }
    [[nodiscard]] std::size_t tool_count() const noexcept { return tools_.size(); }
    [[nodiscard]] const Frame& rest_frame(std::size_t tool) const noexcept { return tools_[tool].rest; }
    /// Empty unless the tool is bonded.
    [[nodiscard]] const std::vector<Bond>& bonds(std::size_t tool) const noexcept {
        return tools_[tool].bonds;
    }
    /// Of the last solve that was measured.
    [[nodiscard]] const ToolLoad& load(std::size_t tool) const noexcept { return loads_[tool]; }

  private:
    struct Tool {
        Frame rest;
        std::vector<Bond> bonds;          ///< bonded
        std::vector<TouchedSet> touched;  ///< one, or none if bonded
    };

    void list_constraints(const NodeReader& predicted) noexcept;
    [[nodiscard]] Frame moved(std::size_t tool, const Attempt& attempt) const noexcept;

    BondedNodes bonded_nodes_;
    std::vector<Tool> tools_;
    Owners bonded_owners_, owners_;
    std::vector<Constraint> constraints_;
    std::vector<ToolLoad> loads_;
    std::vector<Frame> predicted_;  ///< [tools]
    int friction_updates_ = 0;
    std::size_t fewest_violators_ = 0;
    int passes_without_gain_ = 0;
    int early_changes_ = 0;
};

}  // namespace knead::core
