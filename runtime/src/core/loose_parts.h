// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/constraint.h"
#include "core/model.h"
#include "core/node_field.h"

namespace knead::core {

/// Connected parts none of whose nodes is fixed or bonded to a tool, in ascending order of their first nodes.
/// @param model without its loose parts
[[nodiscard]] std::vector<LoosePart> find_loose_parts(const Model& model);

/// Whether a tool holds one of its nodes.
[[nodiscard]] bool is_touched(const LoosePart& part, const std::vector<Constraint>& constraints) noexcept;

/// Gives back the spin that one linearisation took or made.
///
/// Elastic forces have no torque about where they act, so that implicit Euler, solved to the end, leaves a
/// part that nothing holds or touches with sum m x1 x (v1 - v0) = 0 about its centre of mass. The linearised
/// step of stiff matter misses that by up to a few hundredths of the spin in a second. What is missing is a
/// turn of the whole part, which strains nothing.
/// @param displacements_m, velocities_m_per_s after the step
/// @param beyond_m dt (v1 - v0)
template <class S>
void give_spin(const LoosePart& part, const Model& model, Real dt_s, NodeField<S>& displacements_m,
               NodeField<S>& velocities_m_per_s, NodeField<S>& beyond_m) noexcept;

}  // namespace knead::core
