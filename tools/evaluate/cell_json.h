// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "evaluate/evaluation.h"

namespace knead::tools {

/// A result as it stands in the report. A number that is not known is null.
[[nodiscard]] nlohmann::ordered_json to_json(const CellResult& cell);

/// What the cache keeps of a cell; the rest is known from the request.
[[nodiscard]] std::string to_cache(const CellResult& cell);
/// Fills `cell` from the cache. @return false when the text is not a kept cell
[[nodiscard]] bool from_cache(const std::string& text, CellResult& cell);

/// The same for times and sizes.
[[nodiscard]] std::string times_to_cache(const CellResult& cell);
[[nodiscard]] bool times_from_cache(const std::string& text, CellResult& cell);

/// The same for runtime against baseline, and for curves.
[[nodiscard]] nlohmann::ordered_json to_json(const SpeedResult& speed);
[[nodiscard]] std::string speed_to_cache(const SpeedPair& pair);
[[nodiscard]] bool speed_from_cache(const std::string& text, SpeedPair& pair);
[[nodiscard]] std::string curve_to_cache(const ForceCurve& curve);
[[nodiscard]] bool curve_from_cache(const std::string& text, ForceCurve& curve);

}  // namespace knead::tools
