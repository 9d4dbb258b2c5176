// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/size_search.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace knead::tools {
namespace {

/// A length and the logarithm of how many times too many tetrahedra it gave.
struct Trial {
    double length;
    double excess;
};

/// The next length to try. Between a length that gave too many and one that gave too few, where the straight
/// line between their logarithms crosses zero, kept away from both ends so that jumps cannot stall the
/// search; otherwise from the third-power law, a few times the size at most, so that no trial becomes huge.
double next_length(const std::optional<Trial>& too_many, const std::optional<Trial>& too_few) {
    if (too_many && too_few) {
        const double share = too_many->excess / (too_many->excess - too_few->excess);
        const double low = std::log(too_many->length);
        const double high = std::log(too_few->length);
        return std::exp(low + std::clamp(share, 0.1, 0.9) * (high - low));
    }
    const Trial& trial = too_many ? *too_many : *too_few;
    const double step = std::clamp(trial.excess / 3, -1.1, 1.1);
    return trial.length * std::exp(step * 1.02);  // a little further, to get the crossing bracketed
}

}  // namespace

SizeSearchResult search_edge_length(std::size_t wanted, double first_guess,
                                    const std::function<std::size_t(double&)>& count_at) {
    SizeSearchResult best;
    std::optional<Trial> too_many;
    std::optional<Trial> too_few;
    double best_error = INFINITY;
    double length = first_guess;
    while (best.meshings < kMaxMeshings) {
        const std::size_t count = count_at(length);
        ++best.meshings;
        const double excess =
            std::log(static_cast<double>(std::max<std::size_t>(count, 1)) / static_cast<double>(wanted));
        if (std::abs(excess) < best_error) {
            best_error = std::abs(excess);
            best.edge_length = length;
            best.count = count;
        }
        const double error = std::abs(static_cast<double>(count) / static_cast<double>(wanted) - 1);
        best.within_tolerance = error <= kCountTolerance;
        if (best.within_tolerance) return best;
        auto& side = excess > 0 ? too_many : too_few;
        // Jumps can put a trial outside of the bracket's order: the newest word on each side counts.
        side = Trial{length, excess};
        length = next_length(too_many, too_few);
    }
    return best;
}

}  // namespace knead::tools
