// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "knead/haptics/export.h"

namespace knead {

/// When data are too old to push with: whole until stale_after_s, then fading in a straight line, nothing
/// from zero_after_s on.
struct Watchdog {
    double stale_after_s = 0.02;  ///< > 0
    double zero_after_s = 0.05;   ///< >= stale_after_s, at most kLongestSilence_s

    /// No configuration lets a force outlive its data by more: s.
    static constexpr double kLongestSilence_s = 0.05;

    /// What is left of the force, 0 to 1. @param age_s of the data; not a number or below zero counts as too
    /// old
    [[nodiscard]] KNEAD_HAPTICS_API double share(double age_s) const noexcept;
};

}  // namespace knead
