// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "touch/press_curve.h"
#include "touch/z_width.h"

namespace knead::tools {

/// Depths whose force is told.
inline constexpr std::array<double, 4> kToldDepths_m{1e-3, 2e-3, 5e-3, 10e-3};

/// The stiffest coupling of one way to run the loop.
struct RenderableRate {
    HapticMode mode = HapticMode::synchronous;
    double rate_hz = 1000;
    double simulation_rate_hz = 0;  ///< two-rate only
    ZWidth width;
};

/// What a device can render of one object under one tool, at a force scale of 1.
struct Renderability {
    PressCurve curve;
    std::optional<double> saturation_depth_m;       ///< of the tool; nothing: not within the curve
    std::optional<double> saturation_hand_depth_m;  ///< through a coupling as stiff as the device renders
    double force_scale = 1;  ///< largest, at most 1, at which the whole curve stays within the device's force
    std::vector<RenderableRate> rates;  ///< synchronous 1 kHz, two-rate 60, 120, 500 Hz
};

/// Measures in virtual time: the press curve, then the stiffest coupling that stays stable and passive in a
/// simulated hand on the device, for each way to run the loop. Deterministic.
/// @param progress called before each part with how many are done, of how many, and what comes
[[nodiscard]] Renderability find_renderability(
    const Asset& asset, std::size_t tool, const PressLine& line, const DevicePreset& preset,
    const std::function<void(std::size_t, std::size_t, const std::string&)>& progress = {});

[[nodiscard]] std::string renderability_text(const Asset& asset, std::size_t tool, const DevicePreset& preset,
                                             const Renderability& found);
/// Schema "knead-touch-renderability/1" (docs/touch.md).
[[nodiscard]] std::string renderability_json(const Asset& asset, const std::string& asset_content_hash,
                                             std::size_t tool, const DevicePreset& preset,
                                             const Renderability& found);

}  // namespace knead::tools
