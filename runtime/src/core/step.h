// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/types.h"
#include "knead/formats/asset.h"
#include "knead/formats/numerics.h"
#include "knead/runtime/config.h"
#include "knead/runtime/local_model.h"
#include "knead/runtime/step_result.h"

namespace knead::core {

enum class SimdTarget : std::uint8_t;

inline constexpr double kSmallestStep_s = 0.25e-3;
inline constexpr double kLargestStep_s = 20e-3;

/// The whole simulation of one object under its tools: constant model, state, and the step between states.
///
/// No files, threads, locks, exceptions or RTTI; allocates when made only.
class Stepper {
  public:
    virtual ~Stepper() = default;

    /// @param poses [tools of the config]
    virtual StepResult step(const Pose* poses, double dt_s) noexcept = 0;
    /// Of the last step.
    [[nodiscard]] virtual const ToolResult& tool(std::size_t index) const noexcept = 0;
    /// As Simulation::local_model().
    virtual bool local_model(std::size_t tool, LocalModel& out) noexcept = 0;
    virtual void reset() noexcept = 0;

    [[nodiscard]] virtual std::size_t tool_count() const noexcept = 0;
    [[nodiscard]] virtual std::size_t node_count() const noexcept = 0;
    /// In the asset's order. @param out [nodes][3]
    virtual void positions_m(double* out) const noexcept = 0;
    virtual void velocities_m_per_s(double* out) const noexcept = 0;
    [[nodiscard]] virtual std::size_t factor_bytes() const noexcept = 0;
};

/// @param asset valid  @param config valid, its tools in the asset  @param target this processor has it
std::unique_ptr<Stepper> make_stepper(const Asset& asset, const SimulationConfig& config,
                                      const Numerics& numerics, SimdTarget target);
/// With the numerics that fit the asset and the fastest instructions of this processor.
std::unique_ptr<Stepper> make_stepper(const Asset& asset, const SimulationConfig& config);

}  // namespace knead::core
