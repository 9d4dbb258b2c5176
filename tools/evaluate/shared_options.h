// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What the command lines of knead-evaluate and knead-tune have in common.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/evaluation.h"

namespace knead::tools {

/// Where results are kept, as it was typed.
struct CacheOptions {
    std::filesystem::path folder;  ///< empty: "knead/evaluate" in the user's folder for caches
    bool none = false;
};

void declare_options(CLI::App& app, CacheOptions& options);

/// The cache of this program: another build computes anew. @throws ToolError(cannot_write)
[[nodiscard]] ResultCache open_cache(const CacheOptions& options);

/// --bins and --clusters of the paper's method.
void declare_paper_method(CLI::App& app, std::vector<std::uint32_t>& bins,
                          std::vector<std::uint32_t>& clusters);

/// "10%" or "0.1" as a share; nothing when it is no number.
[[nodiscard]] std::optional<double> share_of(std::string text);

}  // namespace knead::tools
