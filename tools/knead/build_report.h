// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "knead/asset_gate.h"
#include "knead/build.h"

namespace knead::tools {

/// "steak.k3.hdf: radius ratio 0.32 at least, a step of 1 ms probably 14 us (6 to 42), 1 warning"
[[nodiscard]] std::string summary(const std::string& name, const GatedAsset& asset);

/// For --report: stages with their times, assets with their quality.
[[nodiscard]] std::string build_report(const BuildResult& result, const std::vector<GatedAsset>& gated);

}  // namespace knead::tools
