// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "baseline/machine.h"
#include "evaluate/paper/document.h"
#include "evaluate/paper/summary.h"

namespace knead::tools {

/// Where and how the numbers were made.
struct PaperRun {
    baseline::Machine machine;
    std::string commit, command, date;
    double seconds = 0;  ///< of this run; what was kept from an earlier one took no time
};

/// The paper's tables with ours beside them: Table 1, Table 2, the counts, Figure 8, the steak, the checks.
[[nodiscard]] std::vector<DocumentPart> paper_document(const PaperSummary& summary, const PaperRun& run);

/// The numbers of the tables, for the member "paper_run" of the evaluation.
[[nodiscard]] nlohmann::ordered_json to_json(const PaperSummary& summary);

/// One line for each mesh of Table 1, for each cell of Table 2 (reference forces too), for each point of
/// Figure 8; each with a header.
[[nodiscard]] std::string table1_csv(const PaperSummary& summary);
[[nodiscard]] std::string table2_csv(const PaperSummary& summary);
[[nodiscard]] std::string figure8_csv(const PaperSummary& summary);

}  // namespace knead::tools
