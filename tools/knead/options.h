// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace knead::tools {

/// What the command line of `knead build` says.
struct BuildOptionsGiven {
    std::filesystem::path scene;
    std::filesystem::path folder;
    std::filesystem::path asset;  ///< empty: no copy
    std::vector<std::string> levels;
    bool force = false;
    bool dry_run = false;
    bool strict = false;
    bool check = false;
    bool no_check = false;
};

void declare_options(CLI::App& app, BuildOptionsGiven& options);

}  // namespace knead::tools
