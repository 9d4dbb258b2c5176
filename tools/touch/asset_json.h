// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "knead/formats/asset.h"

namespace knead::tools {

/// Which asset, and which of its tools, a report is about.
[[nodiscard]] nlohmann::ordered_json asset_json(const Asset& asset, const std::string& content_hash,
                                                std::size_t tool);

}  // namespace knead::tools
