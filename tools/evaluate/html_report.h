// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace knead::tools {

/// What the template of the page has in the place of the data, exactly once.
inline constexpr const char* kReportPlaceholder = "@KNEAD_EVALUATION@";

/// The evaluation in fewer bytes, as the page reads it (docs/evaluation.md has the schema it comes from):
///   - numbers with a fraction keep 6 significant digits, Young's moduli 4
///   - scenes[].results as a table: {columns: ["method", ..., "step_us.p50", ...], rows: [[...], ...]}; null
///   where
///     a result has no such member. Results with members that a table cannot hold stay as they are
///   - meshes: each mesh of scenes[].states once, as {nodes_m, tetrahedra}; a state has its index as `mesh`
///   - moduli: each youngs_modulus_pa of the states once, where they have few values as {palette: [...],
///     index: [...]}; a state has its index as `modulus`
///   - bins and clusters of states are left out: the page does not show them
nlohmann::json page_data(const nlohmann::json& evaluation);

/// The page: `template_text` with page_data(evaluation) in the place of its placeholder. Any text in the
/// evaluation is safe in the page: no `<` and no character outside ASCII is written unescaped; bytes that are
/// not UTF-8 become U+FFFD.
/// @throws ToolError (bad_input) when the template does not have the placeholder exactly once
std::string html_report(const nlohmann::json& evaluation, const std::string& template_text);

/// Where the template is for a program, in a build tree as when installed: ../share/knead/report.html of the
/// program's folder. The file is missing where Knead was built without npm.
std::filesystem::path html_template_path(const std::filesystem::path& program);

}  // namespace knead::tools
