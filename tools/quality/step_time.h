// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "knead/formats/asset.h"
#include "quality/conditioning.h"

namespace knead::tools {

/// What step() of the runtime will probably take: a prediction from the number of tetrahedra, the arithmetic
/// and the preconditioner, for steps of kPredictedDt_s on the machine of docs/benchmark.md. Not a
/// measurement.
struct StepPrediction {
    double time_us = 0;                ///< half of the steps are faster
    double low_us = 0;                 ///< hardly a step is faster
    double high_us = 0;                ///< of a hundred steps some one may take that long
    std::uint32_t iterations = 1;      ///< of the conjugate gradients, in most steps
    std::uint32_t max_iterations = 3;  ///< likewise, in the worst
    Preconditioner preconditioner = Preconditioner::sparse_inverse;  ///< at kPredictedDt_s
    bool calibrated = true;  ///< false: nothing like it was measured, the bounds are guesses
};

inline constexpr double kPredictedDt_s = 1e-3;
inline constexpr const char* kCalibrationMachine =
    "one core of an AMD EPYC (Zen 4, AVX-512) virtual machine, g++ 12.2 -O3, 2026-11-22";

[[nodiscard]] StepPrediction predict_step(const Asset& asset, const Conditioning& conditioning);

}  // namespace knead::tools
