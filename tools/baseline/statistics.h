// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace knead::baseline {

/// Times of many steps, microseconds.
struct Percentiles {
    double min = 0, p50 = 0, p99 = 0, p999 = 0;
};

/// Nearest rank: the smallest value that at least the share of all values does not exceed.
[[nodiscard]] inline double percentile(const std::vector<double>& increasing, double share) {
    if (increasing.empty()) return 0;
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(increasing.size())));
    return increasing[std::max<std::size_t>(rank, 1) - 1];
}

[[nodiscard]] inline Percentiles percentiles(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return {percentile(values, 0), percentile(values, 0.5), percentile(values, 0.99),
            percentile(values, 0.999)};
}

}  // namespace knead::baseline
