// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "knead/formats/material.h"
#include "knead/formats/tet_mesh.h"
#include "reference/static_problem.h"

namespace knead::tools {

/// Where an object is and how fast it moves.
struct MotionState {
    std::vector<Point> positions_m;         ///< [mesh nodes]
    std::vector<Point> velocities_m_per_s;  ///< [mesh nodes]
};

/// What acts on the whole object.
struct BodyForces {
    Point gravity_m_per_s2{};
    double damping_per_s = 0;  ///< mass-proportional, >= 0
};

/// A step of the motion: the new state and how it was found.
struct MotionStep {
    MotionState state;
    StaticSolution solution;  ///< reactions include the inertia of the prescribed nodes themselves
};

/// Converged implicit Euler steps of the object of StaticProblem, mass lumped at the nodes.
///
/// One step solves, to the limits given: M ((x1 - x0) / dt - v0) / dt = -dE/dx(x1) + M g - d M (x1 - x0) /
/// dt, with v1 = (x1 - x0) / dt; prescribed nodes are at rest + displacement at the end of the step. A
/// reaction is what the object exerts on the holder: -(dE/dx + the inertia and damping terms - M g) of that
/// node.
/// @thread-safety one thread at a time; different objects are independent
class ImplicitEuler {
  public:
    /// @throws ToolError(bad_input) when the mesh or the material breaks an invariant of its type, or a body
    ///     force is not finite, or the damping negative
    ImplicitEuler(const TetMesh& mesh, const Material& material, const BodyForces& forces = {});
    ImplicitEuler(ImplicitEuler&&) noexcept;
    ImplicitEuler& operator=(ImplicitEuler&&) noexcept;
    ~ImplicitEuler();

    [[nodiscard]] MotionState rest() const;

    /// @param dt_s > 0, finite
    /// @throws ToolError(bad_input), ToolError(no_valid_result) as StaticProblem::solve()
    [[nodiscard]] MotionStep step(const MotionState& from, const PrescribedMotion& prescribed, double dt_s,
                                  const NewtonLimits& limits = {});

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace knead::tools
