// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "knead/formats/compare.h"
#include "knead/formats/result.h"

namespace knead::tools {

/// Tolerances as the command line spells them: "1e-9" for every floating-point dataset, "nodes_m=1e-9" or
/// "/knead/mesh/nodes_m=1e-9" for one. Throws bad_usage.
[[nodiscard]] CompareOptions compare_options(const std::vector<std::string>& absolute,
                                             const std::vector<std::string>& relative);

/// The name of a code as docs/errors.md and the header spell it: "wrong_type".
[[nodiscard]] const char* name_of(ErrorCode code);

/// "asset.hdf#/knead/...: wrong_type: message", the line that `knead-asset validate` prints for an issue.
[[nodiscard]] std::string issue_line(const Error& error);

}  // namespace knead::tools
