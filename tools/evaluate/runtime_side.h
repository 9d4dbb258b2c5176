// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "knead/formats/asset.h"

namespace knead::tools {

/// What the runtime says of a press that is held until nothing moves.
struct RuntimeRest {
    double force_n = 0;  ///< against the direction of the press
    bool is_still = false;
    std::uint32_t status = 0;  ///< StepStatus bits of all steps
};

/// Presses a tool of an asset from its rest pose along `direction` by `way_m` and holds it.
/// @throws ToolError(no_valid_result) when the runtime refuses the asset
[[nodiscard]] RuntimeRest press_until_still(const Asset& asset, std::size_t tool, const Point& direction,
                                            double way_m);

/// Force over time under a slow press, for the paper's Figure 8: down in 15 s, held for 5 s.
struct ForceCurve {
    std::vector<double> time_s;
    std::vector<double> force_n;
};
[[nodiscard]] ForceCurve press_curve(const Asset& asset, std::size_t tool, const Point& direction,
                                     double way_m);

/// Median of `repetitions` loads from a file, milliseconds.
[[nodiscard]] double time_load_ms(const std::filesystem::path& asset_file, int repetitions);

}  // namespace knead::tools
