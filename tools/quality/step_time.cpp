// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/step_time.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace knead::tools {
namespace {

/// The first table of docs/benchmark.md: scenario 1, bonded plate, 1 ms, median. A test compares the two.
struct Measured {
    double tetrahedra;
    double time_us;
};
constexpr std::array<Measured, 4> kMeasured{{{1'296, 15.0}, {3'072, 46.1}, {6'000, 93.6}, {48'000, 2325.7}}};

// How much longer than there a step takes in harder matter: docs/benchmark.md, "Hard cases", 1 ms.
constexpr double kFactorLonger = 2.2;              ///< 3x3 factor instead of the sparse inverse
constexpr double kTurningLonger = 1.6;             ///< contrast above 100: every node's rotation in each step
constexpr double kStiffLonger = 2.9;               ///< contrast above 1e4 in float32
constexpr double kDoubleLonger = 3.3;              ///< all in float64
constexpr double kNearlyIncompressible = 0.45;     ///< from here on the factor is needed, or more iterations
constexpr double kNearlyIncompressibleMore = 1.6;  ///< beside turning or float64
constexpr double kContactLonger = 1.4;             ///< "Leaving things out": ball with friction
constexpr double kUncalibratedLonger = 6;

// What lies between the best and the worst of a hundred steps, and between a quiet and a busy machine: minima
// are 1.04 to 2.2 times below the medians of the first table, 99 % of the steps below 1.6 to 2.4 times them.
constexpr double kLow = 1 / 2.5;
constexpr double kHigh = 3;
constexpr double kUncalibratedHigh = 30;

/// Of the easiest matter. Between two measured sizes a power law, beyond them the last one's per tetrahedron.
double easy_time_us(double tetrahedra) {
    if (tetrahedra <= kMeasured.front().tetrahedra)
        return std::max(1.0, kMeasured.front().time_us * tetrahedra / kMeasured.front().tetrahedra);
    for (std::size_t k = 1; k < kMeasured.size(); ++k) {
        if (tetrahedra > kMeasured[k].tetrahedra) continue;
        const Measured& a = kMeasured[k - 1];
        const Measured& b = kMeasured[k];
        const double power = std::log(b.time_us / a.time_us) / std::log(b.tetrahedra / a.tetrahedra);
        return a.time_us * std::pow(tetrahedra / a.tetrahedra, power);
    }
    return kMeasured.back().time_us * tetrahedra / kMeasured.back().tetrahedra;
}

/// How much longer than in the easiest matter.
double hardness(const Numerics& numerics, Preconditioner preconditioner) {
    const bool nearly_incompressible = numerics.max_poissons_ratio > kNearlyIncompressible;
    const double more = nearly_incompressible ? kNearlyIncompressibleMore : 1;
    if (numerics.arithmetic != Precision::float32) return kDoubleLonger * more;
    if (numerics.contrast > 1e4) return kStiffLonger;  // nearly incompressible too
    if (numerics.contrast > 1e2) return kTurningLonger * more;
    return nearly_incompressible || preconditioner == Preconditioner::factor ? kFactorLonger : 1;
}

}  // namespace

StepPrediction predict_step(const Asset& asset, const Conditioning& conditioning) {
    const Numerics& numerics = conditioning.numerics;
    StepPrediction prediction;
    prediction.preconditioner = conditioning.preconditioner_at(kPredictedDt_s);
    prediction.time_us = easy_time_us(static_cast<double>(numerics.tetrahedra)) *
                         hardness(numerics, prediction.preconditioner);
    if (prediction.preconditioner == Preconditioner::factor) {
        prediction.iterations = 2;
        prediction.max_iterations = 7;
    } else if (prediction.preconditioner == Preconditioner::laplacian) {
        prediction.iterations = 3;
        prediction.max_iterations = 6;
    } else if (!conditioning.mass_rules(
                   kPredictedDt_s)) {  // too large for a factor and too hard for a Laplacian: never measured
        prediction.calibrated = false;
        prediction.iterations = 20;
        prediction.max_iterations = 200;
        prediction.time_us *= kUncalibratedLonger;
    }
    const bool touches = std::any_of(asset.tools.begin(), asset.tools.end(),
                                     [](const ToolSet& tool) { return tool.contact != ToolContact::bonded; });
    if (touches) prediction.time_us *= kContactLonger;
    prediction.low_us = kLow * prediction.time_us;
    prediction.high_us = (prediction.calibrated ? kHigh : kUncalibratedHigh) *
                         (touches ? kContactLonger : 1) * prediction.time_us;
    return prediction;
}

}  // namespace knead::tools
