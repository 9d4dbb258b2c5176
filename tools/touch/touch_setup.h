// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "knead/formats/asset.h"
#include "knead/haptics/haptic_loop.h"
#include "knead/runtime/config.h"
#include "touch/device_presets.h"
#include "touch/touch_request.h"

namespace knead::tools {

/// Where a tool of an asset starts, and which way it presses.
struct PressLine {
    Pose rest;
    Vec3 direction{0, 0, -1};  ///< unit, scene frame
};

/// Everything a run needs, made from asset, device and request. The device's origin is at the tool's rest
/// pose; its axes are the scene's.
struct TouchSetup {
    TouchRequest request;
    std::string device_name;
    std::size_t tool = 0;  ///< index in the asset
    PressLine line;
    HapticConfig haptic;
    SimulationConfig simulation;
    double seconds = 0;

    [[nodiscard]] std::uint64_t tick_count() const;
};

/// @param tool index or name. Fails as bad usage with the names that there are.
[[nodiscard]] std::size_t find_tool(const Asset& asset, const std::string& tool);
/// From the rest pose, along `direction` (scene frame, any length above zero) if there is one. Else a plate
/// presses where its face looks, along its -z axis; a sphere and a capsule towards the box of the nodes that
/// they can touch, or along -z where they are in it.
[[nodiscard]] PressLine press_line(const Asset& asset, std::size_t tool,
                                   const std::optional<Vec3>& direction = {});

/// Longest run, s: what the haptic loop does in it still fits into memory as a log.
inline constexpr double kLongestTouch_s = 3600;

/// Fails as bad usage for a tool that is not there or a run of more than kLongestTouch_s.
[[nodiscard]] TouchSetup make_touch_setup(const Asset& asset, const DevicePreset& preset,
                                          const TouchRequest& request);

/// The device of a setup: a script, or a simulated hand on the preset's device.
[[nodiscard]] std::unique_ptr<Device> make_device(const TouchSetup& setup, const DevicePreset& preset);

}  // namespace knead::tools
