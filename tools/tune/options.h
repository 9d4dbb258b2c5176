// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The command line of knead-tune.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "evaluate/shared_options.h"
#include "tune/tune.h"

namespace knead::tools {

/// The command line as it was typed.
struct TuneOptions {
    std::vector<std::filesystem::path> scenes;
    std::string within = "10%";
    std::string budget;
    std::string budget_of = "p99";
    std::vector<std::string> on;
    std::vector<std::string> held_out;
    std::vector<std::string> methods;
    std::vector<std::uint32_t> bins{2, 3, 4};
    std::vector<std::uint32_t> clusters{1, 3, 6, 10};
    std::vector<std::string> levels;
    std::uint32_t seeds = 3;
    std::uint32_t verify_seeds = 10;
    int steps = 250;
    int repeats = 40;
    std::filesystem::path json;
    std::filesystem::path write_scene;
    CacheOptions cache;
};

void declare_options(CLI::App& app, TuneOptions& options);

/// Checks every name and number. @throws ToolError(bad_usage), with the nearest name; cannot_write
[[nodiscard]] TuneRequest request_of(const TuneOptions& options);

/// "200us", "0.2ms" or "200" (microseconds). @throws ToolError(bad_usage)
[[nodiscard]] double budget_us_of(const std::string& text);

}  // namespace knead::tools
