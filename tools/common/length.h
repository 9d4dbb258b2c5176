// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace knead::tools {

/// Metres per unit name: m, dm, cm, mm, um, in, ft. Throws bad_usage for another name.
[[nodiscard]] double metres_per_unit(const std::string& unit);

/// "0.004", "4mm", "1.5 cm" -> metres. A bare number counts as metres. Throws bad_usage.
[[nodiscard]] double parse_length_m(const std::string& text);

}  // namespace knead::tools
