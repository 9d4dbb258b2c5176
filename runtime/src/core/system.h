// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/constraint.h"
#include "core/elements.h"

namespace knead::core {

/// One tool in the equations: where it is predicted and, if it is coupled to the hand, three more unknowns,
/// its displacement t beyond the prediction against mass, spring and damper.
struct ToolUnknown {
    bool moves = false;  ///< false: the tool is where the hand is, t = 0
    Real mass_kg = 0;
    Vec force_n = Vec::Zero();    ///< of the coupling on the hand at t = 0
    Vec inertia_n = Vec::Zero();  ///< what the tool's mass answers at t = 0: it was predicted where it is
    Real rate_n_per_m = 0;        ///< how that force grows with t: stiffness + damping / dt
};

/// A displacement of every node and of the tools beyond the prediction; or what belongs to one (residuals,
/// forces).
template <class S>
struct Unknowns {
    NodeField<S> nodes;
    std::vector<Vec> tools;
};

/// Masses as the kernels read them: of free nodes, zero for all others; and their inverses.
template <class S>
struct Masses {
    explicit Masses(const Model& model);
    NodeField<S> kg, per_kg;
};

/// The linear system of one step, A d = b with A = (1 + c dt) M + dt^2 K(R), never assembled.
///
/// Nodes of a bonded tool move with it, nodes of `constraints` in part. Two forms of a vector: *expanded*,
/// with the displacements of such nodes as they are, and *projected*, where their rows have been moved to the
/// tool. A maps expanded to rows; project() makes rows a residual.
template <class S>
struct System {
    const Model& model;
    const Stiffness<S>& stiffness;
    const Masses<S>& masses;
    const FieldKernels<S>& fields;
    const std::vector<Constraint>& constraints;
    const std::vector<ToolUnknown>& tools;
    Real dt_s = 0;
    Real inertia = 1;  ///< 1 + damping * dt

    /// out = A u for all nodes, kg times the unit of u; inertia of free nodes only.
    void apply(Unknowns<S>& u, NodeField<S>& out) const noexcept;

    /// Keeps the free part of every held row and adds the held part to the row of its tool, if that moves.
    void project(Unknowns<S>& rows) const noexcept;

    /// Gives held nodes the tool's motion; the inverse view of project().
    void expand(Unknowns<S>& u) const noexcept;

    /// A moving tool's own diagonal with the nodes bonded to it, kg.
    [[nodiscard]] Real tool_diagonal_kg(std::size_t tool) const noexcept;
};

}  // namespace knead::core
