// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "quality/gate.h"

namespace knead::tools {
namespace {

/// Linear tetrahedra lock from here on: docs/quality.md has the measurement.
constexpr double kLockingPoissonsRatio = 0.45;
/// Stiffest over softest elasticity up to which steps were tested (docs/benchmark.md, "Hard cases").
constexpr double kTestedContrast = 1e9;
/// Of a second: the usual period of a haptic loop.
constexpr double kHapticPeriod_us = 1000;

}  // namespace

Findings examine_matter(const Asset& asset, const Conditioning& conditioning) {
    Findings findings;
    const Numerics& numerics = conditioning.numerics;
    if (numerics.max_poissons_ratio > kLockingPoissonsRatio) {
        const auto locking = std::count_if(
            asset.palette_index.begin(), asset.palette_index.end(),
            [&](std::uint32_t index) { return asset.palette[index].poissons_ratio > kLockingPoissonsRatio; });
        findings.push_back(
            {true, "locks", numerics.max_poissons_ratio, "",
             fmt::format("{} of {} tetrahedra have a Poisson's ratio above {:g} (the largest {:g}): linear "
                         "tetrahedra lock and feel too stiff",
                         locking, asset.tetrahedra.size(), kLockingPoissonsRatio,
                         numerics.max_poissons_ratio),
             "use 0.45 or less: for what a hand feels it differs little from incompressible matter"});
    }
    if (numerics.contrast > kTestedContrast)
        findings.push_back({true, "contrast", numerics.contrast, "",
                            fmt::format("the stiffest tetrahedron is {:.3g} times as stiff as the softest; "
                                        "tested up to {:g}",
                                        numerics.contrast, kTestedContrast),
                            "hold what does not deform ([[held]]) instead of making it stiff"});
    return findings;
}

Findings examine_step(const Conditioning& conditioning, const StepPrediction& step) {
    Findings findings;
    if (step.time_us > kHapticPeriod_us)
        findings.push_back(
            {true, "step-slow", step.time_us, "us",
             fmt::format(
                 "a step will probably take {:.0f} us ({:.0f} to {:.0f}): longer than the millisecond "
                 "of a haptic loop",
                 step.time_us, step.low_us, step.high_us),
             "bake a coarser level, or render with the local model between steps (docs/haptics.md)"});
    const double crossings = kPredictedDt_s / conditioning.fastest_crossing_s;
    findings.push_back(
        {false, "fastest-wave", conditioning.fastest_crossing_s, "s",
         fmt::format("the fastest wave crosses a tetrahedron in {:.2g} s, {:.2g} times in a step of 1 ms: "
                     "implicit steps stay stable and damp what is faster than they are",
                     conditioning.fastest_crossing_s, crossings),
         "nothing"});
    return findings;
}

}  // namespace knead::tools
