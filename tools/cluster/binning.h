// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace knead::tools {

/// How the range of Young's moduli is cut into bins.
enum class Binning : std::uint8_t {
    equal_width,       ///< bins of equal width over [Emin, Emax]: the paper's choice
    equal_population,  ///< about equally many tetrahedra in each bin
    equal_width_log,   ///< equal width in log E, for contrasts over about 100
    kmeans,            ///< the bins with the smallest sum of squared distances to their means (exact, 1-D)
};

/// The largest number of bins that Binning::kmeans takes (its memory grows with bins times values).
inline constexpr std::uint32_t kMaxKmeansBins = 256;

/// Bin of every value; bin 0 holds the smallest. Empty bins are dropped and the rest renumbered, equal values
/// share a bin, and the ranges of two bins never touch. The last bin is closed.
/// @param youngs_modulus_pa not empty, finite, > 0
/// @param bins >= 1, otherwise bad_usage; fewer come back when there are fewer different values
/// Source: paper section 3.2, "Initialization".
[[nodiscard]] std::vector<std::uint32_t> bin_values(std::span<const double> youngs_modulus_pa,
                                                    std::uint32_t bins, Binning binning);

}  // namespace knead::tools
