// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "evaluate/paper/report.h"

namespace knead::tools {

/// Writes paper.txt, paper.md, paper.json, paper.html (where the page was built), results.csv, table1.csv,
/// table2.csv and figure8.csv into a folder, each replaced only once complete.
/// @param scenes results of evaluate_paper()
/// @throws ToolError(cannot_write)
PaperSummary write_paper(const std::filesystem::path& folder, const std::vector<SceneResult>& scenes,
                         const PaperRun& about);

}  // namespace knead::tools
