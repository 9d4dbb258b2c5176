// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "knead/level_check.h"
#include "knead/plan.h"
#include "quality/gate.h"

namespace knead::tools {

/// When levels are compared with the fine object.
enum class WhenToCheck {
    automatic,  ///< where the fine object has at most kCheckedByItself tetrahedra
    always,
    never
};

/// Up to here the comparison takes at most about a tenth of the build (docs/quality.md).
inline constexpr std::size_t kCheckedByItself = 4'000;

/// What is known of a finished asset.
struct GatedAsset {
    const PlannedAsset* asset = nullptr;
    QualityReport report;
    std::vector<PressComparison> presses;  ///< [tools of the scene]; empty: not compared
    Findings findings;                     ///< those of the report and of the comparison

    [[nodiscard]] std::size_t warning_count() const;
};

/// Reads the assets of a finished build and looks at them, and at how each answers compared with the fine
/// object. Writes nothing.
/// @param wants_check says for an asset whether `check` applies to it
/// @throws ToolError when a file of the build cannot be read
[[nodiscard]] std::vector<GatedAsset> gate_assets(
    const Scene& scene, const Plan& plan, WhenToCheck check,
    const std::function<bool(const PlannedAsset&)>& wants_check);

}  // namespace knead::tools
