// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/contact.h"
#include "core/converted.h"
#include "core/linearisations.h"
#include "core/solver.h"
#include "core/step.h"
#include "core/tool_impedance.h"

namespace knead::core {

/// A tool between steps and in the one under way.
struct SteppedTool {
    Frame frame;                                                             ///< predicted
    Vec position = Vec::Zero(), velocity = Vec::Zero(), hand = Vec::Zero();  ///< after the last step
    /// Of the nodes bonded to it: place in the tool's frame, velocity, and displacement (all in double,
    /// because a force is read from their changes).
    std::vector<Vec> anchors, displacements_m, velocities, next_m, accelerations;
};

/// S: the numbers of the state, in which it is predicted and linearised; V: those of the solve, S or
/// narrower.
template <class S, class V>
class TypedStepper final : public Stepper {
  public:
    TypedStepper(const Asset& asset, const SimulationConfig& config, const Numerics& numerics,
                 SimdTarget target);

    StepResult step(const Pose* poses, double dt_s) noexcept override;
    [[nodiscard]] const ToolResult& tool(std::size_t index) const noexcept override {
        return results_[index];
    }
    bool local_model(std::size_t tool, LocalModel& out) noexcept override;
    void reset() noexcept override;
    [[nodiscard]] std::size_t tool_count() const noexcept override { return tools_.size(); }
    [[nodiscard]] std::size_t node_count() const noexcept override { return model_.rest_m.size(); }
    void positions_m(double* out) const noexcept override;
    void velocities_m_per_s(double* out) const noexcept override;
    [[nodiscard]] std::size_t factor_bytes() const noexcept override {
        return preconditioner_.factor_bytes();
    }

  private:
    /// Ends a solve as soon as it shows that other nodes are touched than those that it is for.
    class EarlyLook final : public Watcher<V> {
      public:
        EarlyLook(TypedStepper& stepper, const SolverLimits& limits) : stepper_(stepper), limits_(limits) {}
        void begin() noexcept { looks_ = 0; }
        bool stops(const Solution<V>& solution) noexcept override;

      private:
        TypedStepper& stepper_;
        const SolverLimits& limits_;
        int looks_ = 0;
    };

    void make_room_for_views(const std::vector<ToolSet>& tools);
    [[nodiscard]] bool carries_too_far(std::size_t k) const noexcept;
    void predict(const Frame* hands, Real dt) noexcept;
    void couple(SteppedTool& tool, ToolUnknown& unknown, const Frame& hand, Real dt) const noexcept;
    void predict_bonded(std::size_t k) noexcept;
    void linearise(const System<V>& system) noexcept;
    [[nodiscard]] Real way_of_solution_m() const noexcept;
    [[nodiscard]] bool went_far() const noexcept;
    Real cut_overshoot(Real last_m) noexcept;
    void predict_again(const System<V>& system) noexcept;
    std::uint32_t solve_with_contact(const System<V>& system) noexcept;
    [[nodiscard]] bool settled(const SolverLimits& limits, std::uint32_t& status) noexcept;
    [[nodiscard]] Attempt attempt(const SolverLimits& limits, bool early) const noexcept;
    [[nodiscard]] bool finite() const noexcept;
    void accept(const Frame* hands, Real dt, bool failed) noexcept;
    void go_beyond(const NodeField<S>& d, Real dt) noexcept;
    void owe(Real dt) noexcept;
    void find_results(Real dt) noexcept;
    void list_held(std::size_t k) noexcept;
    [[nodiscard]] System<V> system(Real dt) noexcept;
    StepResult refuse(std::uint32_t status) noexcept;
    [[nodiscard]] StepResult result(std::uint32_t status) const noexcept;
    [[nodiscard]] Real travel_m() const noexcept;
    [[nodiscard]] const NodeField<S>& ahead() const noexcept { return again_ ? ahead_ : beyond_; }
    [[nodiscard]] bool coupled() const noexcept { return config_.coupling_stiffness_n_per_m > 0; }

    const SimulationConfig config_;
    const Kernels& kernels_;
    const FieldKernels<S>& fields_;        ///< of the state
    const FieldKernels<V>& solve_fields_;  ///< of the solve
    const Model model_;
    const Masses<V> masses_;
    Elements<S, V> elements_;
    Contact contact_;
    Preconditioner<V> preconditioner_;
    Solver<V> solver_;
    const bool trusts_preconditioner_;
    const bool unilateral_;  ///< some tool is
    const Linearisations linearisations_;

    // State: what a step starts from.
    NodeField<S> displacements_, velocities_;
    /// By how much the last step ended beyond where velocities alone would have carried it: about as far as
    /// the next one will, while forces change smoothly.
    NodeField<S> beyond_;
    Real beyond_dt_s_ = 1;
    Real smoothness_ = 0;  ///< how well that was true of the last step, 0 to 1
    /// What the last solve left of its right-hand side, kg m: an impulse that was not given. It is given in
    /// the next step, so that small errors do not add up to a drift.
    NodeField<S> owed_;
    Real owed_dt_s_ = 1;
    std::vector<SteppedTool> tools_;

    // Of the step under way.
    NodeField<S> predicted_, load_, scratch_;
    /// predicted_ is beyond where velocities alone would carry the nodes by ahead_share_ of beyond_; in a
    /// step that was linearised again, of ahead_.
    NodeField<S> ahead_;
    Real ahead_share_ = 0;
    bool again_ = false;
    bool inside_out_ = false;  ///< a tetrahedron is, where the step was linearised
    Converted<V, S> for_solve_;
    Converted<S, V> from_solve_;
    std::vector<Frame> hands_, frames_;
    std::vector<ToolUnknown> unknowns_;
    Solution<V> solution_;
    std::uint32_t iterations_ = 0;
    std::vector<ToolResult> results_;

    // For linear views, if asked for.
    std::vector<ToolReach> reaches_;  ///< [tools]
    std::optional<ToolImpedance<V>> impedance_;
    std::vector<HeldPart> held_;
    Real step_dt_s_ = 0;       ///< of the last step; zero: refused, or none yet
    std::uint64_t steps_ = 0;  ///< since reset()
};

}  // namespace knead::core
