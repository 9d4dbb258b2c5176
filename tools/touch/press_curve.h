// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "knead/formats/asset.h"
#include "touch/touch_setup.h"

namespace knead::tools {

/// What an object answers to a tool pressed to one depth, at rest.
struct PressPoint {
    double depth_m = 0;            ///< of the tool from its rest pose, along the press
    double force_n = 0;            ///< norm
    double stiffness_n_per_m = 0;  ///< static, along the press
    std::uint32_t touched_nodes = 0;
};

/// A press in stairs, each long enough to come to rest.
struct PressCurve {
    std::vector<PressPoint> points;  ///< depths strictly increase, from zero
    double stair_m = 0;              ///< from one to the next

    [[nodiscard]] double deepest_m() const { return points.back().depth_m; }
    /// Straight between two stairs. Nothing beyond the deepest.
    [[nodiscard]] std::optional<PressPoint> at(double depth_m) const;
    /// Where the force first reaches `force_n`; nothing if it does not.
    [[nodiscard]] std::optional<double> depth_of_force(double force_n) const;
    /// The first stair that touches; nothing if none does.
    [[nodiscard]] std::optional<PressPoint> contact() const;
};

/// How deep a press curve goes: 10 mm, or this share of the object's extent along the press.
inline constexpr double kDeepestPress_m = 10e-3;
inline constexpr double kDeepestShare = 0.3;

/// Presses the tool of `line` in virtual time, in steps of 20 ms, whose damping brings the object to rest.
/// Fails as bad input when the asset cannot be simulated, and as no valid result when a step fails.
[[nodiscard]] PressCurve press_curve(const Asset& asset, std::size_t tool, const PressLine& line);

}  // namespace knead::tools
