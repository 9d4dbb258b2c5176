// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/solver.h"
#include "knead/formats/asset.h"

namespace knead::core {

/// Which nodes the tool holds, and how: hard constraints by an active set that starts from the step before.
///
/// Bonded: all of the tool's nodes, always, rigidly. Unilateral: a node that would pass the surface is held
/// on it (sticking: at the point where it came; frictionless: along the normal only, the tangent plane taken
/// anew each step), and let go when it would have to be pulled. Within one step a node is caught at most once
/// and let go at most once, so that passes end. No penalty forces. Allocates in the constructor only.
class Contact {
  public:
    /// @param tool valid, of the asset that `model` was built from
    Contact(const ToolSet& tool, const Model& model);

    void reset() noexcept;

    /// The touched set of the step before, held for a tool predicted at `tool`.
    void begin_step(const Frame& tool, const Field& predicted_m) noexcept;

    /// Lets go of what would be pulled and catches what would pass.
    /// @param tool as in begin_step(); solution.displacement.tool says how far it really went
    /// @param pull_tolerance_n a pull up to this is the solver's error
    /// @return whether the set changed: solve again
    bool revise(const Frame& tool, const Field& predicted_m, const Solution& solution,
                Real pull_tolerance_n) noexcept;

    /// After an accepted step. @param tool where it is now
    void end_step(const Frame& tool, const Field& positions_m) noexcept;

    /// Back to before begin_step().
    void abandon_step() noexcept { candidates_ = before_; }

    [[nodiscard]] const std::vector<Constraint>& constraints() const noexcept { return constraints_; }
    [[nodiscard]] std::size_t max_constraints() const noexcept { return candidates_.size(); }
    [[nodiscard]] const Frame& rest_frame() const noexcept { return rest_frame_; }

  private:
    /// A node that the tool may touch. Vectors in the tool's frame.
    struct Candidate {
        std::uint32_t node = 0;
        bool held = false;
        bool beyond = false;  ///< behind the plate's plane, but it went there beside the rectangle
        bool caught = false;  ///< in this step
        bool let_go = false;  ///< in this step
        Vec anchor = Vec::Zero();
        Vec normal = Vec::Zero();  ///< out of the tool
    };

    void place_on_surface(Candidate& candidate, const Vec& local) const noexcept;
    [[nodiscard]] Real depth(const Vec& local) const noexcept;
    [[nodiscard]] bool beside(const Vec& local) const noexcept;
    void list_constraints(const Frame& tool, const Field& predicted_m) noexcept;

    ToolShape shape_;
    ToolContact kind_;
    Real radius_m_;
    std::array<Real, 2> half_extents_m_;
    Frame rest_frame_;
    Real gap_tolerance_m_;
    std::vector<Candidate> at_rest_, candidates_, before_;
    std::vector<Constraint> constraints_;
    std::vector<std::size_t> candidate_of_;  ///< [constraints]
};

}  // namespace knead::core
