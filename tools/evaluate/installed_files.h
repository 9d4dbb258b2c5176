// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace knead::tools {

/// The page that html_report() fills, from beside this program; empty where Knead was built without npm.
[[nodiscard]] std::string page_template();

/// The same, for who asked for the page. @throws ToolError(no_valid_result) when there is none
[[nodiscard]] std::string required_page_template();

/// data/paper.json, beside the page. @throws ToolError(no_valid_result) when it is not there
[[nodiscard]] nlohmann::ordered_json papers_numbers();

}  // namespace knead::tools
