// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "baseline/statistics.h"
#include "bench/accuracy.h"
#include "knead/formats/material.h"

namespace knead::bench {

/// A motion or a material that breaks careless solvers (docs/benchmark.md), and what is asked of it.
struct HardCase {
    std::string name;
    std::function<MaterialObject()> object;
    Motion motion;
    double dt_s = 1e-3;
    double compared_s = 0;  ///< of the motion's time: with exact steps; the rest is run alone
    double largest_error = 1e-3;
    /// A larger error is right too when the step said not_converged.
    bool may_be_told = false;
    bool trajectory_defined =
        true;  ///< false: tiny differences grow, as inverted tetrahedra right themselves
    std::optional<double> largest_rest;  ///< root mean square distance from rest at the end, over the side
};

struct HardCaseRow {
    std::string name;
    std::uint64_t tetrahedra = 0;
    double dt_ms = 0;
    Accuracy accuracy;  ///< of the compared part
    bool trajectory_defined = true;
    baseline::Percentiles us;
    bool finite = true;
    bool bounded = true;         ///< no force above kBound times the largest exact one
    std::optional<double> rest;  ///< as HardCase::largest_rest
    std::string verdict;         ///< "ok", "told", or what is wrong
    bool pass = false;
};

/// All cases, or those of a quick run.
[[nodiscard]] std::vector<HardCase> hard_cases(bool quick);

[[nodiscard]] HardCaseRow measure_hard_case(const HardCase& hard_case);

}  // namespace knead::bench
