// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "reference/newton.h"
#include "reference/static_problem.h"

namespace knead::tools {

/// Brings the prescribed unknowns from where they are to `target_m` and the free ones to the minimum of the
/// objective: in the load steps asked for, halved when Newton fails and doubled again when it does not.
/// @throws ToolError(bad_input) when the limits ask for less than one load step
/// @param positions_m in: where to start; out: the minimum
/// @throws ToolError(no_valid_result) with the residual and the iterations
[[nodiscard]] StaticSolution equilibrium(const Objective& objective, FreeSystem& system,
                                         const PrescribedMotion& motion, const Eigen::VectorXd& target_m,
                                         const NewtonLimits& limits, Eigen::VectorXd& positions_m);

}  // namespace knead::tools
