// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "touch/touch_setup.h"

namespace knead::tools {

/// The command line of knead-touch as it was typed; touch_request() reads the texts.
struct TouchOptions {
    enum class Command { run, replay, renderability, list_devices };

    std::filesystem::path asset;
    std::filesystem::path replay;  ///< empty: not said
    std::string renderability;     ///< a device; empty: not said
    bool list_devices = false;
    std::filesystem::path log, json;
    std::string device = "touch";

    std::string depth = "5mm", speed = "50mm/s";
    std::string mode = "synchronous", rendering = "reduced-object";
    bool no_passivity = false, real_time = false;
    TouchRequest request;  ///< what needs no reading

    std::vector<CLI::Option*> run_only, two_rate_only;  ///< to tell which were given
    CLI::Option *tool_option = nullptr, *direction_option = nullptr, *json_option = nullptr;
    std::vector<double> direction;

    [[nodiscard]] Command command() const;
};

void declare_options(CLI::App& app, TouchOptions& options);

/// Checks every value and what does not go together, and reads the texts. Throws bad_usage.
[[nodiscard]] TouchRequest touch_request(const TouchOptions& options);

/// Everything that changes a run, defaults included, SI units, in a fixed order; no path.
[[nodiscard]] std::vector<std::string> canonical_arguments(const TouchSetup& setup);

}  // namespace knead::tools
