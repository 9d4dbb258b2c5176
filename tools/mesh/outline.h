// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string_view>
#include <vector>

namespace knead::tools {

/// Reads the corners of a closed outline: two numbers a line, x and y, separated by a comma or blanks; #
/// starts a comment. The first corner may be repeated at the end. In the file's length unit. Refuses
/// (bad_input, with the line) what is not that, fewer than three corners or more than 10,000, a corner twice
/// in a row, and an outline that crosses itself.
[[nodiscard]] std::vector<std::array<double, 2>> read_outline(std::string_view content);

}  // namespace knead::tools
