// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "knead/formats/session_log.h"
#include "knead/haptics/device.h"
#include "knead/haptics/run_statistics.h"
#include "touch/touch_meter.h"
#include "touch/touch_setup.h"

namespace knead::tools {

/// What a run tells while it goes on; both are called on the thread that called run_touch().
struct TouchListener {
    /// Every show_period_s of the run's own time.
    std::function<void(const TouchTotals&, const RunStatistics&)> show;
    double show_period_s = 0.1;
    /// Asked often; true ends the run early, as if its time were over.
    std::function<bool()> interrupted;
};

/// What came out of a run.
struct TouchOutcome {
    TouchTotals totals;
    RunStatistics statistics;  ///< real time only; else all zero
    bool interrupted = false;
    std::optional<SessionLog> log;  ///< if it was wanted
    /// The configuration by name, as in a log.
    std::vector<SessionLog::Setting> settings;
};

/// Runs the haptic loop of a setup: in real time on threads of its own, or in virtual time on this one. The
/// last force on the device is zero, however it ends. In virtual time the same arguments give the same
/// outcome, bit for bit; a step of a two-rate simulation then arrives kLatencyPeriods of its periods after
/// its start. Fails as bad input when the asset cannot be simulated so.
/// @param asset_content_hash for the log
[[nodiscard]] TouchOutcome run_touch(const Asset& asset, const std::string& asset_content_hash,
                                     const TouchSetup& setup, Device& device, bool with_log,
                                     const TouchListener& listener);

inline constexpr double kLatencyPeriods = 0.12;

}  // namespace knead::tools
