// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/types.h"

namespace knead::core {

/// A free node that a tool holds during a solve: `held` (a projector: identity, or n n^T of a sliding node)
/// times the node's displacement equals `held` times (the tool's displacement + offset_m).
struct Constraint {
    std::uint32_t node = 0;
    std::uint32_t tool = 0;
    Mat held = Mat::Identity();
    Vec offset_m = Vec::Zero();
    /// Friction of the tool on the node, at right angles to `held`: a load of this solve, zero unless the
    /// node slips. The tool carries the opposite.
    Vec friction_n = Vec::Zero();
};

/// What the tool feels at a held node. @param row_n of the node, elastic and inertial, before friction
inline Vec force_on_tool(const Constraint& constraint, const Vec& row_n) {
    return constraint.held * row_n - constraint.friction_n;
}

}  // namespace knead::core
