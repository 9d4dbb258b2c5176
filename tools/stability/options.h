// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The part of knead-evaluate's command line that runs the stability matrix.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>

#include "common/run_tool.h"
#include "stability/report.h"

namespace knead::tools::stability {

/// As it was typed; --json and -j are those of knead-evaluate.
struct StabilityOptions {
    bool wanted = false;
    bool shortened = false;
    std::string cells;
    std::uint64_t soak_steps = 100'000;
};

void declare_options(CLI::App& app, StabilityOptions& options);

/// Runs the cells, prints the table and writes the JSON (empty: none).
/// @return answer_is_no when a cell fails
/// @throws ToolError(bad_usage) when no cell's name has the pattern
ExitCode run_stability(ToolContext& context, const StabilityOptions& options,
                       const StabilityProvenance& provenance, const std::filesystem::path& json);

}  // namespace knead::tools::stability
