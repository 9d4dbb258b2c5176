// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "knead/formats/read.h"

namespace knead {

/// How far two numbers may lie apart and still count as the same: |a - b| <= absolute + relative * max(|a|,
/// |b|). Zero and zero: bit for bit the same value (-0 equals 0, the same NaN equals
/// itself).
struct Tolerance {
    double absolute = 0;
    double relative = 0;
};

struct CompareOptions {
    Tolerance
        tolerance;  ///< of every floating-point dataset not named below; integers and texts are always exact
    std::map<std::string, Tolerance> dataset_tolerance;  ///< by path, or by the last part of it ("nodes_m")
};

/// One dataset, group or attribute in which two files differ.
struct Difference {
    std::string path;
    std::string message;  ///< "3 of 80 values differ, first at [4, 2]: 1.5 and 1.25; largest difference 0.25"
    std::uint64_t count = 0;      ///< elements that differ; 0: presence, type or extents differ
    double largest_absolute = 0;  ///< numbers only
};

/// Compares the payload of two files, whatever their kinds; provenance is not part of it.
/// @return the differences in the order of their paths; empty: the same. Errors as the readers, and
/// invalid_argument for a tolerance that is negative or not finite, or names no dataset of either file
Result<std::vector<Difference>> compare_files(const std::filesystem::path& a, const std::filesystem::path& b,
                                              const CompareOptions& options = {},
                                              const ReadLimits& limits = {});

}  // namespace knead
