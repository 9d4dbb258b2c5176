// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace knead::tools {

/// Runs a program and waits for it; its standard error arrives piece by piece at `on_stderr`, its standard
/// output is dropped. No shell is involved.
/// @return its exit code, or 128 + the signal that ended it. Throws ToolError when it cannot be started.
int run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
              const std::function<void(std::string_view)>& on_stderr);

/// The tool of this name in the folder of the running program, or else on PATH.
/// Throws ToolError(bad_usage) when it is not installed.
[[nodiscard]] std::filesystem::path find_tool(const std::string& name);

}  // namespace knead::tools
