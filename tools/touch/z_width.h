// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "knead/formats/asset.h"
#include "knead/haptics/haptic_loop.h"
#include "knead/haptics/simulated_operator.h"
#include "knead/runtime/config.h"

namespace knead::tools {

/// One way of rendering one object on one device in one hand, up to the coupling's stiffness. The hand waits,
/// presses the tool in from a little before its rest pose, holds, lets go and waits again, in virtual time.
struct ZWidthSetup {
    HapticConfig haptic;  ///< its workspace is replaced: the device's origin is at the tool's rest pose
    SimulationConfig simulation;
    OperatorConfig hand;  ///< device and hand; path and period are replaced
    double latency_periods =
        0.12;                   ///< two-rate: from the start of a step to its arrival, in its periods, >= 0
    Vec3 direction{0, 0, -1};   ///< of the press, scene frame, unit
    double clearance_m = 1e-3;  ///< from the start to the rest pose; a bonded tool starts there
    double press_share = 0.4;   ///< of the device's force that the press asks for at most, (0, 1]
    double hold_s = 1.0;        ///< at the deepest point
};

/// What one run with one stiffness showed.
struct ZWidthProbe {
    bool stable = false;  ///< while holding: oscillation fades, or is within the bound and does not grow
    bool passive =
        false;  ///< energy given to the hand never passed what it had put in by more than the bound
    double oscillation_m = 0;  ///< peak to peak of the device's true position, last third of the hold
    double given_j = 0;  ///< most energy that the hand had got from the object, net; below zero: it paid
    double force_n = 0;  ///< mean norm on the device in the last third of the hold
    std::uint32_t haptic_status = 0;  ///< HapticStatus bits of all ticks
    std::uint32_t step_status = 0;    ///< StepStatus bits

    [[nodiscard]] bool good() const { return stable && passive; }
};

/// Bounds of a good run and of the search.
struct ZWidthSearch {
    double least_n_per_m = 25;
    double most_n_per_m = 102400;
    double ratio = 1.05;            ///< resolution: of a stiffness that is good to one that is not, > 1
    double oscillation_counts = 5;  ///< peak to peak, encoder counts ...
    double oscillation_m = 1e-4;    ///< ... or metres, whichever is more
    double epsilon_j = 5e-4;        ///< of the energy balance
    bool must_be_stable = true;     ///< false: only passive
    bool must_be_passive = true;    ///< false: only stable
};

/// The range of the coupling's stiffness, measured.
struct ZWidth {
    double stiffness_n_per_m = 0;  ///< largest good one found; 0: not even the least
    bool at_most = false;          ///< the largest one tried is good: the range may be wider
    int probes = 0;
    ZWidthProbe good;  ///< at `stiffness_n_per_m`
    ZWidthProbe bad;   ///< at the smallest stiffness found bad
};

/// Runs one stiffness. Deterministic. Fails as bad input when asset or configuration do.
[[nodiscard]] ZWidthProbe probe_stiffness(const Asset& asset, const ZWidthSetup& setup,
                                          double stiffness_n_per_m, const ZWidthSearch& search = {});

/// Doubles the stiffness from the least on until it is not good, then bisects that octave on a logarithmic
/// scale. What is good beyond the first bad octave is not found.
[[nodiscard]] ZWidth find_z_width(const Asset& asset, const ZWidthSetup& setup,
                                  const ZWidthSearch& search = {});

}  // namespace knead::tools
