// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "knead/formats/asset.h"
#include "knead/formats/result.h"
#include "knead/runtime/export.h"
#include "knead/runtime/pose.h"

namespace knead {

/// What happened in a step; bits, so that several can be told at once. Zero is a good step.
enum StepStatus : std::uint32_t {
    kStepOk = 0,
    kStepNotConverged = 1u << 0,  ///< the solver stopped at its cap; the force is its best estimate
    kStepNotFinite = 1u << 1,     ///< the state would not be finite: force zero, last good state kept
    kStepBadInput = 1u << 2,      ///< pose or dt not finite or out of range: force zero, state kept
    kStepContactCap = 1u << 3,    ///< the set of touched nodes had not settled at its cap
};

/// Choices that do not belong to the asset.
struct SimulationConfig {
    std::size_t tool = 0;               ///< which of the asset's tools the poses of step() move
    double force_tolerance = 1e-4;      ///< relative bound aimed at for the force error of one step
    int max_solver_iterations = 500;    ///< of the conjugate gradients, per solve
    int max_contact_passes = 8;         ///< changes of the touched set tried in one step

    /// Spring and damper between the pose that step() is given (the hand) and the tool in the scene, solved
    /// together with the object. Zero stiffness: no coupling, the tool is at the given pose.
    double coupling_stiffness_n_per_m = 0;
    double coupling_damping_n_s_per_m = 0;
    double tool_mass_kg = 0.05;         ///< used with a coupling only, > 0
};

/// What one step yields.
struct StepResult {
    /// On the hand: what the object (or, with a coupling, the coupling) exerts. Newtons, scene frame.
    Vec3 force_n{};
    std::uint32_t status = kStepOk;     ///< StepStatus bits
    std::uint32_t solver_iterations = 0;
    std::uint32_t touched_nodes = 0;
    Vec3 tool_position_m{};             ///< where the tool is; the given position unless coupled
};

/// One soft object with one tool: implicit Euler, corotational linear tetrahedra (paper section 3.1, [MG04]).
///
/// Threads: one thread at a time; different objects are independent. step() and reset() never allocate,
/// lock, throw or do I/O. Same asset, configuration, inputs and machine type: the same bits.
class KNEAD_RUNTIME_API Simulation {
  public:
    /// Reads and validates an asset, then prepares to step. Allocates everything that steps need.
    /// @return the simulation, or any error of read_asset(), or invalid_argument for a bad config
    static Result<Simulation> load(const std::filesystem::path& asset_file, const SimulationConfig& config = {});
    /// The same from memory; validates `asset`.
    static Result<Simulation> create(const Asset& asset, const SimulationConfig& config = {});

    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;
    ~Simulation();

    /// Advances by dt_s with the tool (the hand, if coupled) at `pose` at the end of the step.
    /// @param dt_s 0.25e-3 to 20e-3 seconds; may differ from step to step
    StepResult step(const Pose& pose, double dt_s) noexcept;

    /// Back to the rest state, at rest, tool at its rest pose.
    void reset() noexcept;

    [[nodiscard]] std::size_t node_count() const noexcept;
    [[nodiscard]] std::size_t tetrahedron_count() const noexcept;
    /// Current positions, metres: node_count() x 3, asset node order, valid until the next step().
    [[nodiscard]] const double* positions_m() const noexcept;
    /// The tool's rest pose from the asset: start here.
    [[nodiscard]] Pose tool_rest_pose() const noexcept;

  private:
    struct Impl;
    explicit Simulation(std::unique_ptr<Impl> impl) noexcept;
    std::unique_ptr<Impl> impl_;
};

}  // namespace knead
