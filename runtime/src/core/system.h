// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/element_pass.h"

namespace knead::core {

/// A free node that the tool holds during a solve: `held` (a projector: identity, or n n^T of a sliding node)
/// times the node's displacement equals `held` times (the tool's displacement + offset_m).
struct Constraint {
    std::uint32_t node = 0;
    Mat held = Mat::Identity();
    Vec offset_m = Vec::Zero();
};

/// The tool as three more unknowns: its displacement t beyond the prediction, against mass, spring and
/// damper.
struct ToolUnknown {
    bool moves = false;  ///< false: the tool is where the hand is, t = 0
    Real mass_kg = 0;
    Vec force_n = Vec::Zero();  ///< of the coupling on the hand at t = 0
    Real rate_n_per_m = 0;      ///< how that force grows with t: stiffness + damping / dt
};

/// A displacement of every node and of the tool beyond the prediction; or what belongs to one (residuals,
/// forces).
struct Unknowns {
    Field nodes;
    Vec tool = Vec::Zero();
};

/// The linear system of one step, A d = b with A = (1 + c dt) M + dt^2 K(R), never assembled.
///
/// Two forms of a vector: *expanded*, with the displacements of held nodes as they are, and *projected*,
/// where the rows of held nodes have been moved to the tool. A maps expanded to rows; project() makes rows a
/// residual.
struct System {
    const Model& model;
    const ElementPass& pass;
    const std::vector<Constraint>& constraints;
    ToolUnknown tool;
    Real dt_s = 0;
    Real inertia = 1;  ///< 1 + damping * dt

    /// out = A u for the nodes, kg times the unit of u; rows of nodes that the asset holds are zero.
    void apply(const Field& u, Field& out) const noexcept;

    /// Keeps the free part of every held row and adds the held part to the tool's row (if the tool moves).
    void project(Unknowns& rows) const noexcept;

    /// Gives held nodes the tool's motion; the inverse view of project().
    void expand(Unknowns& u) const noexcept;

    /// The tool's own diagonal, kg.
    [[nodiscard]] Real tool_diagonal_kg() const noexcept {
        return tool.mass_kg + dt_s * dt_s * tool.rate_n_per_m;
    }
};

}  // namespace knead::core
