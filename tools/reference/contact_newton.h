// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "reference/contact_set.h"
#include "reference/step_model.h"

namespace knead::tools {

/// Counts of a solve in contact.
struct ContactEffort {
    int newton_iterations = 0;
    int law_iterations = 0;
    int law_fallbacks = 0;
};

/// The conditions of contact at these positions, with the touching nodes as `set` has them.
[[nodiscard]] ContactCheck check_contact(const StepModel& model, const std::vector<bool>& is_prescribed,
                                         const Eigen::VectorXd& target_m, const ContactSet& set,
                                         const Eigen::VectorXd& positions_m, const ContactLimits& limits);
[[nodiscard]] bool is_met(const ContactCheck& check);

/// Newton's method on the smooth part, the laws of contact solved exactly in each iteration, and a line
/// search on the smooth part plus an exact penalty of what is violated (friction forces count as given).
/// @param positions_m in: where to start; out: the solution
/// @throws ToolError(no_valid_result) with the figures
[[nodiscard]] ContactEffort solve_contact(StepModel& model, FreeSystem& system,
                                          const Eigen::VectorXd& target_m, const ContactLimits& limits,
                                          ContactSet& set, Eigen::VectorXd& positions_m, ContactCheck& check);

}  // namespace knead::tools
