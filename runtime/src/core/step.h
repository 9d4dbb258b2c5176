// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact.h"
#include "knead/runtime/config.h"
#include "knead/runtime/step_result.h"

namespace knead::core {

inline constexpr double kSmallestStep_s = 0.25e-3;
inline constexpr double kLargestStep_s = 20e-3;

/// The whole simulation of one object under one tool: constant model, state, and the step between states.
///
/// No files, threads, locks, exceptions or RTTI; allocates in the constructor only.
class Stepper {
  public:
    /// @param asset valid  @param config valid, its tool in the asset
    Stepper(const Asset& asset, const SimulationConfig& config);
    Stepper(const Stepper&) = delete;
    Stepper& operator=(const Stepper&) = delete;

    StepResult step(const Pose& pose, double dt_s) noexcept;
    void reset() noexcept;

    [[nodiscard]] const Model& model() const noexcept { return model_; }
    [[nodiscard]] const Field& positions_m() const noexcept { return positions_; }
    [[nodiscard]] const Field& velocities_m_per_s() const noexcept { return velocities_; }
    [[nodiscard]] const Contact& contact() const noexcept { return contact_; }

  private:
    void predict(const Frame& hand, Real dt_s) noexcept;
    void linearise(Real dt_s) noexcept;
    std::uint32_t solve_with_contact(Real dt_s) noexcept;
    StepResult accept(const Frame& hand, Real dt_s, std::uint32_t status) noexcept;
    [[nodiscard]] StepResult refuse(std::uint32_t status) const noexcept;
    [[nodiscard]] bool coupled() const noexcept { return config_.coupling_stiffness_n_per_m > 0; }
    [[nodiscard]] bool finite() const noexcept;

    const SimulationConfig config_;
    const Model model_;
    ElementPass pass_;
    Contact contact_;
    Preconditioner preconditioner_;
    Solver solver_;

    // State: what a step starts from.
    Field positions_, velocities_;
    Vec tool_position_ = Vec::Zero(), tool_velocity_ = Vec::Zero(), hand_position_ = Vec::Zero();

    // Of the step under way.
    Field predicted_, load_;
    Frame tool_;  ///< predicted
    ToolUnknown coupling_;
    Solution solution_;
    std::uint32_t iterations_ = 0;
};

}  // namespace knead::core
