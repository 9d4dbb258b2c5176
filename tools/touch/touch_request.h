// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "knead/haptics/haptic_loop.h"

namespace knead::tools {

/// A press: in along a line from the tool's rest pose (press_line()), hold, and back.
struct Press {
    double depth_m = 5e-3;         ///< > 0
    double speed_m_per_s = 50e-3;  ///< on the way in, > 0
    double hold_s = 1;             ///< >= 0
    double release_s = 0.2;        ///< for the way back, > 0
};

/// What a user asks knead-touch to run. SI units.
struct TouchRequest {
    std::string tool = "0";         ///< index or name
    std::optional<Vec3> direction;  ///< of the press, scene frame; nothing: the tool's own way
    Press press;
    bool simulated_hand =
        false;  ///< the press is what a hand wants that holds the device; else what the device does
    HapticMode mode = HapticMode::synchronous;
    LocalRendering rendering = LocalRendering::reduced_object;
    double rate_hz = 1000;
    double simulation_rate_hz = 120;
    double force_scale = 1;
    std::optional<double> coupling_n_per_m;  ///< nothing: as stiff as the device renders
    std::optional<double> max_force_n;       ///< nothing: the device's
    bool passivity = true;
    std::optional<double> seconds;  ///< nothing: until the press is over
    bool virtual_time = false;
};

}  // namespace knead::tools
