// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "material/sources.h"

namespace knead::tools {

/// A whole text as one finite or non-finite number ("1e3", "nan"), without regard to the locale; blanks
/// around it are allowed. Anything else: std::nullopt.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// One tetrahedron per line: "E" or "E,nu,density", the same on every line. A first line without any number
/// is a header; blank lines at the end are allowed, blank lines between rows are not.
/// @throws bad_input "line 7: ..." (lines counted from 1)
[[nodiscard]] ValueTable parse_value_csv(std::string_view text);

/// One region per line: "region,E,nu,density". The name may hold commas and may stand in double quotes.
/// Header and blank lines as above. @throws bad_input "line 7: ..."
[[nodiscard]] std::vector<RegionValues> parse_region_csv(std::string_view text);

/// The command line's "NAME=E,NU,DENSITY"; the last "=" separates. @throws bad_usage
[[nodiscard]] RegionValues parse_region_option(std::string_view text);

}  // namespace knead::tools
