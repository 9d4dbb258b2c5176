// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "stability/stability.h"

namespace knead::tools::stability {

/// What a report says about where it comes from.
struct StabilityProvenance {
    nlohmann::ordered_json machine;
    std::string commit, command;
};

/// {schema: "knead-stability/1", machine, commit, command, counts, cells, warnings}: docs/stability.md.
[[nodiscard]] nlohmann::ordered_json stability_json(const std::vector<CellResult>& cells,
                                                    const StabilityProvenance& provenance);
/// One line for each cell, and the counts.
[[nodiscard]] std::string stability_table(const std::vector<CellResult>& cells);

struct StabilityCounts {
    std::size_t pass = 0, warn = 0, fail = 0;
};
[[nodiscard]] StabilityCounts count_of(const std::vector<CellResult>& cells);

}  // namespace knead::tools::stability
