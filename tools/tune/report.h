// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "baseline/machine.h"
#include "tune/tune.h"

namespace knead::tools {

/// What a person reads: the meshes and their times, the candidates, the answer and its evidence.
/// @param with_all every candidate, not only the best of each mesh
[[nodiscard]] std::string text_report(const TuneResult& result, bool with_all);

/// One line: what was found, or what comes nearest.
[[nodiscard]] std::string verdict(const TuneResult& result);

/// Everything, schema "knead-tune/1" (docs/tune.md).
[[nodiscard]] nlohmann::ordered_json json_report(const std::vector<TuneResult>& results,
                                                 const baseline::Machine& machine,
                                                 const std::string& command);

}  // namespace knead::tools
