// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "evaluate/loads.h"

namespace knead::tools {

/// Names and groups ("press", "pads", "all") as loads, each once, in the order of the tables. The scene's own
/// ("scene", "scene:TOOL") come last; the scene knows its tools.
/// @throws ToolError(bad_usage) with the nearest name
[[nodiscard]] std::vector<std::string> loads_of(const std::vector<std::string>& names, const char* option);

/// The groups' names and the loads in them, for --help.
[[nodiscard]] std::string group_help();

/// Loads of the same kind that a level for these loads has not seen: a press of 15 % for the presses, each
/// pad at the place opposite to its own (docs/tune.md).
[[nodiscard]] std::vector<std::string> siblings_of(const std::vector<std::string>& loads);

/// The named loads that are neither among these nor their siblings.
[[nodiscard]] std::vector<std::string> other_loads(const std::vector<std::string>& loads);

/// Whether the name is a load of ours: a sibling, which knead-evaluate does not know.
[[nodiscard]] bool is_sibling(const std::string& name);
/// @pre is_sibling(name)
[[nodiscard]] Load sibling_load(const std::string& name, const Box& object);

/// Small pads first: the loads that most levels fail at.
[[nodiscard]] std::vector<std::string> hardest_first(std::vector<std::string> loads);

}  // namespace knead::tools
