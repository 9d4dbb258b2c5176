// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "baseline/machine.h"
#include "evaluate/evaluation.h"

namespace knead::tools {

/// Mean and spread over the seeds of one method on one mesh under one load.
struct Spread {
    std::size_t seeds = 0;
    std::size_t converged = 0;
    std::size_t within_jnd = 0;
    double mean = 0;       ///< of the force error, over what converged
    double deviation = 0;  ///< sample standard deviation; 0 for one seed
    double lowest = 0, highest = 0;
    double displacement_error = 0;  ///< mean
    double force_n = 0;             ///< mean
    double reference_force_n = 0;   ///< mean
    const CellResult* first = nullptr;
};

/// One row for each different (load, mesh, method), in the order of the cells.
[[nodiscard]] std::vector<Spread> spreads(const SceneResult& scene);

/// The tables of all scenes as text.
[[nodiscard]] std::string text_report(const std::vector<SceneResult>& scenes);

/// The report, schema "knead-evaluation/1" (docs/evaluation.md).
[[nodiscard]] nlohmann::ordered_json json_report(const std::vector<SceneResult>& scenes,
                                                 const baseline::Machine& machine, const std::string& commit,
                                                 const std::string& command);

/// One line for each result, with a header.
[[nodiscard]] std::string csv_report(const std::vector<SceneResult>& scenes);

/// Cells in which the runtime is farther from the reference solver than kRuntimeAgreement, as text; empty:
/// none.
[[nodiscard]] std::string disagreements(const std::vector<SceneResult>& scenes);

/// Number of cells whose error is above `limit` or that did not converge.
[[nodiscard]] std::size_t count_above(const std::vector<SceneResult>& scenes, double limit);

}  // namespace knead::tools
