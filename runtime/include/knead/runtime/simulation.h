// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "knead/formats/asset.h"
#include "knead/formats/result.h"
#include "knead/runtime/config.h"
#include "knead/runtime/export.h"
#include "knead/runtime/local_model.h"
#include "knead/runtime/pose.h"
#include "knead/runtime/step_result.h"

namespace knead {

/// One soft object with its tools: implicit Euler, corotational linear tetrahedra (paper section 3.1,
/// [MG04]).
///
/// Threads: one thread at a time; different objects are independent. step() and reset() never allocate,
/// lock, throw or do I/O. Same asset, configuration, inputs and machine type: the same bits.
class KNEAD_RUNTIME_API Simulation {
  public:
    /// Reads and validates an asset, then prepares to step. Allocates everything that steps need.
    /// @return the simulation, or any error of read_asset(), or invalid_argument for a bad config
    static Result<Simulation> load(const std::filesystem::path& asset_file,
                                   const SimulationConfig& config = {});
    /// The same from memory; validates `asset`.
    static Result<Simulation> create(const Asset& asset, const SimulationConfig& config = {});

    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;
    ~Simulation();

    /// Advances by dt_s with the tool (the hand, if coupled) at `pose` at the end of the step. For
    /// one tool: with several, kStepBadInput.
    /// @param dt_s 0.25e-3 to 20e-3 seconds; may differ from step to step
    StepResult step(const Pose& pose, double dt_s) noexcept;
    /// The same for all tools of the config. @param poses [tool_count()]
    StepResult step(const Pose* poses, double dt_s) noexcept;
    /// What the last step yielded for one tool.
    [[nodiscard]] const ToolResult& tool(std::size_t index) const noexcept;

    /// What the object answers near where a tool stands after the last step. Changes nothing that steps
    /// depend on. For the thread of the steps: no allocation, no lock; takes a few steps' time, more when
    /// the tool has touched or let go of nodes (docs/simulation.md).
    /// @return false, and `out` as it was: SimulationConfig::with_local_model is false, there is no such
    /// tool, or no step since reset(), or the last one was refused (kStepBadInput, kStepNotFinite)
    bool local_model(std::size_t tool, LocalModel& out) noexcept;

    /// Back to the rest state, at rest, tools at their rest poses. Takes as long as loading if steps of
    /// another dt than expected_dt_s came before.
    void reset() noexcept;

    [[nodiscard]] std::size_t tool_count() const noexcept;
    [[nodiscard]] std::size_t node_count() const noexcept;
    [[nodiscard]] std::size_t tetrahedron_count() const noexcept;
    /// Current positions, metres: node_count() x 3, asset node order, valid until the next call. Computed
    /// when asked for, not by step().
    [[nodiscard]] const double* positions_m() const noexcept;
    /// @param out [node_count()][3], asset node order
    void velocities_m_per_s(double* out) const noexcept;
    /// A tool's rest pose from the asset: start here.
    [[nodiscard]] Pose tool_rest_pose(std::size_t index = 0) const noexcept;
    /// Of what conjugate gradients are preconditioned with.
    [[nodiscard]] std::size_t preconditioner_bytes() const noexcept;

  private:
    struct Impl;
    explicit Simulation(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace knead
