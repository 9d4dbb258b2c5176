// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "knead/formats/material.h"
#include "knead/formats/tet_mesh.h"
#include "reference/elasticity_tensor.h"
#include "reference/tied_node.h"

namespace knead::tools {

/// Axes of a node, as bits.
enum Axes : std::uint8_t { kAxisX = 1, kAxisY = 2, kAxisZ = 4, kAllAxes = 7 };

/// Nodes that are held or moved, and where to.
///
/// Invariants: nodes unique and < node count; displacement_m as long as nodes, finite on the prescribed axes;
/// axes empty (all three axes of every node) or as long as nodes, each in [1, 7]. An axis that is not
/// prescribed is free and carries no force.
struct PrescribedMotion {
    std::vector<std::uint32_t> nodes;
    std::vector<Point> displacement_m;  ///< [nodes] from the rest position
    std::vector<std::uint8_t> axes;     ///< [nodes] bits of Axes, or empty
    std::vector<TiedNode> ties{};       ///< StaticProblem only; others refuse them
};

/// An equilibrium, or a step of a motion.
struct StaticSolution {
    std::vector<Point> positions_m;  ///< [mesh nodes]
    /// [prescribed nodes] force with which the object pushes on whatever holds the node, newtons.
    std::vector<Point> reactions_n;
    /// [tied nodes] the same at each tied node, from its own tetrahedra alone. Work on the tool when its
    /// motion changes the displacements of the tied nodes is this force times the change.
    std::vector<Point> tied_reactions_n;
    double energy_j = 0;       ///< elastic energy
    int iterations = 0;        ///< linear solves, those of the load steps included
    int load_steps = 1;        ///< 1: the whole motion in one go
    double residual_n = 0;     ///< Euclidean norm of the unbalanced forces
    double force_scale_n = 0;  ///< Euclidean norm of the reactions
};

/// When a solve is good enough and when it is given up.
struct NewtonLimits {
    double relative_residual =
        1e-10;                ///< residual over force scale; rounding noise of the forces is the floor
    int max_iterations = 60;  ///< of one load step
    /// Equal parts the motion is cut into at least, >= 1. A strongly crushed body has several equilibria
    /// (docs/reference.md): one go may land on another than a slow press comes to; more parts follow it.
    int load_steps = 1;
    int max_load_steps = 1024;  ///< the smallest load step is one over this
};

/// A heterogeneous soft object at rest, asked for its equilibria: the oracle of tests and evaluation.
///
/// Corotational linear tetrahedra in double precision, converged Newton with a line search on the energy,
/// direct sparse solver; the motion is cut into load steps when Newton fails on the whole. Shares no kernel
/// with the runtime. Deterministic, single-threaded per solve.
/// @thread-safety one thread at a time (the elimination order of the last set of prescribed unknowns is
/// kept);
///     different objects are independent
/// Source: paper section 3.1; evaluation.md of the design, "Reference"
class StaticProblem {
  public:
    /// @throws ToolError(bad_input) when the mesh or the material breaks an invariant of its type
    StaticProblem(const TetMesh& mesh, const Material& material);
    /// Any linear elasticity in each tetrahedron (ElasticBody). The iteration then converges more slowly.
    StaticProblem(const TetMesh& mesh, const Material& material,
                  const std::vector<ElasticityTensor>& tensors);
    StaticProblem(StaticProblem&&) noexcept;
    StaticProblem& operator=(StaticProblem&&) noexcept;
    ~StaticProblem();

    /// The equilibrium under `prescribed`, reached from the rest state or from `start_m`.
    /// @param start_m positions to start from ([mesh nodes], finite), or empty: the rest state
    /// @throws ToolError(bad_input) for a bad motion or start; ToolError(no_valid_result), with the residual
    /// and
    ///     the iterations, when no equilibrium is found or the object is not held
    [[nodiscard]] StaticSolution solve(const PrescribedMotion& prescribed,
                                       const std::vector<Point>& start_m = {},
                                       const NewtonLimits& limits = {});

    /// The same for small displacements: one linear solve on the rest state.
    [[nodiscard]] StaticSolution solve_linear(const PrescribedMotion& prescribed);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace knead::tools
