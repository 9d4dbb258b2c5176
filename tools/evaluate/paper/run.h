// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "evaluate/evaluation.h"

namespace knead::tools {

/// The scene of the paper's Figure 8.
inline constexpr const char* kFigure8Scene = "scenario2";

/// "scenario1" to "scenario9".
[[nodiscard]] bool is_scenario(const std::string& scene);

/// The paper's evaluation. Scenarios: homogenised and 2 bins with 1, 3 and 6 clusters on 6,000, 3,072 and
/// 1,296 tetrahedra, pressed by 10 %. Steak: homogenised and 2 bins with 1, 3 and 10 clusters on its coarse
/// mesh, pressed by the spatula (10 clusters are not in the paper). All with force over time, states, and
/// the plain baseline beside the runtime.
/// @param request what is asked for: scenes, seeds, steps to time and threads count; the rest is as above
/// @throws ToolError(bad_usage) for a scene that is not one of the paper's
[[nodiscard]] std::vector<SceneResult> evaluate_paper(const EvaluationRequest& request,
                                                      const ResultCache& cache, const FileReader& read,
                                                      const EvaluationListener& listener);

}  // namespace knead::tools
