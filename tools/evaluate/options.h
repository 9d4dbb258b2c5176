// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The command line of knead-evaluate.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/shared_options.h"
#include "stability/options.h"

namespace knead::tools {

/// The command line as it was typed.
struct EvaluateOptions {
    std::vector<std::filesystem::path> scenes;
    std::vector<std::string> methods{"homogenised", "paper"};
    std::vector<std::uint32_t> bins{2};
    std::vector<std::uint32_t> clusters{1, 3, 6};
    std::vector<std::string> levels;
    std::vector<std::string> loads{"press10"};
    std::uint32_t seeds = 1;
    std::uint64_t seed_base = 1;
    std::string reference = "fine";
    int steps = 2000;
    bool curves = false;
    bool states = false;
    bool beside_paper = false;
    std::filesystem::path json;
    std::filesystem::path csv;
    std::filesystem::path html;
    std::filesystem::path paper;  ///< folder for the paper's evaluation
    std::string fail_above;
    CacheOptions cache;
    stability::StabilityOptions stability;
};

void declare_options(CLI::App& app, EvaluateOptions& options);

/// Checks every name and number. @throws ToolError(bad_usage), with the nearest name
[[nodiscard]] EvaluationRequest request_of(const EvaluateOptions& options, unsigned threads);

/// "10%" or "0.1" as a share; nothing when it was not said. @throws ToolError(bad_usage)
[[nodiscard]] std::optional<double> fail_above_of(const EvaluateOptions& options);

}  // namespace knead::tools
