// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "knead/plan.h"

namespace knead::tools {

/// What became of one stage.
struct StageOutcome {
    const Stage* stage = nullptr;
    bool made = false;  ///< false: it was up to date
    double seconds = 0;
};

/// How a build speaks to its caller while it runs.
struct BuildListener {
    std::function<void(const Stage&, std::size_t index)> begins;  ///< before a stage that has to run
    std::function<void(const StageOutcome&)> ended;
    std::function<void(std::string_view)> stderr_text;  ///< of the tools, as it comes
};

struct BuildOptions {
    unsigned threads = 1;
    bool force = false;    ///< run every stage
    bool verbose = false;  ///< pass --verbose on
};

/// What a build did and what it depended on.
struct BuildResult {
    std::vector<StageOutcome> outcomes;
    std::vector<std::filesystem::path> sources;  ///< files read that no stage made, in order of first use
};

/// Runs the stages that are not up to date, in order, each as a program of its own. Stops at the first that
/// fails and throws ToolError with its exit code; stages finished before stay recorded.
BuildResult run_build(const Plan& plan, const std::filesystem::path& folder, const BuildOptions& options,
                      const BuildListener& listener);

}  // namespace knead::tools
