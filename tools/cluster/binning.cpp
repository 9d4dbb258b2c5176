// SPDX-License-Identifier: GPL-3.0-or-later
#include "cluster/binning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "common/error.h"

namespace knead::tools {
namespace {

using Bins = std::vector<std::uint32_t>;

Bins equal_width(std::span<const double> values, std::uint32_t bins) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double lowest = *low;
    const double width = *high - *low;
    Bins bin_of(values.size(), 0);
    if (width <= 0) return bin_of;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double position = std::floor((values[i] - lowest) / width * bins);
        bin_of[i] = std::min(static_cast<std::uint32_t>(position), bins - 1);  // the last bin is closed
    }
    return bin_of;
}

Bins equal_width_log(std::span<const double> values, std::uint32_t bins) {
    std::vector<double> logs(values.size());
    std::transform(values.begin(), values.end(), logs.begin(), [](double value) { return std::log(value); });
    return equal_width(logs, bins);
}

/// The different values in increasing order, and how often each occurs.
struct Histogram {
    std::vector<double> values;
    std::vector<std::uint64_t> counts;
};

Histogram histogram_of(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    Histogram histogram;
    for (const double value : sorted) {
        if (histogram.values.empty() || histogram.values.back() != value) {
            histogram.values.push_back(value);
            histogram.counts.push_back(0);
        }
        ++histogram.counts.back();
    }
    return histogram;
}

/// Bin of every value from the bin of every different value.
Bins spread(std::span<const double> values, const Histogram& histogram, const Bins& bin_of_different) {
    Bins bin_of(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto found = std::lower_bound(histogram.values.begin(), histogram.values.end(), values[i]);
        bin_of[i] = bin_of_different[static_cast<std::size_t>(found - histogram.values.begin())];
    }
    return bin_of;
}

Bins equal_population(std::span<const double> values, std::uint32_t bins) {
    const Histogram histogram = histogram_of(values);
    Bins bin_of_different(histogram.values.size());
    std::uint64_t rank = 0;
    for (std::size_t i = 0; i < bin_of_different.size(); ++i) {
        bin_of_different[i] = static_cast<std::uint32_t>(rank * bins / values.size());
        rank += histogram.counts[i];
    }
    return spread(values, histogram, bin_of_different);
}

/// Optimal 1-D k-means by dynamic programming: the best cut of the first i values into b bins. The best last
/// cut never moves left when i grows, which lets every row be filled by halving the range of i.
class OptimalCuts {
  public:
    OptimalCuts(const Histogram& histogram, std::uint32_t bins) : size_(histogram.values.size()) {
        sum_prefixes(histogram);
        cost_.resize(size_ + 1);
        for (std::size_t i = 1; i <= size_; ++i)
            cost_[i] = range_cost(0, i);
        for (std::uint32_t bin = 1; bin < bins; ++bin) {
            last_cut_.emplace_back(size_ + 1, 0U);
            next_cost_.assign(size_ + 1, std::numeric_limits<double>::infinity());
            fill(bin + 1, size_, bin, size_ - 1);
            cost_.swap(next_cost_);
        }
    }

    Bins bin_of_different() const {
        Bins bin_of(size_);
        std::size_t end = size_;
        for (auto bin = static_cast<std::uint32_t>(last_cut_.size());; --bin) {
            const std::size_t begin = bin == 0 ? 0 : last_cut_[bin - 1][end];
            std::fill(bin_of.begin() + static_cast<std::ptrdiff_t>(begin),
                      bin_of.begin() + static_cast<std::ptrdiff_t>(end), bin);
            if (bin == 0) return bin_of;
            end = begin;
        }
    }

  private:
    void sum_prefixes(const Histogram& histogram) {
        count_.assign(1, 0);
        sum_.assign(1, 0);
        squares_.assign(1, 0);
        // Measured from the middle of the range and in units of it, so that the squares stay accurate.
        const double middle = 0.5 * histogram.values.front() + 0.5 * histogram.values.back();
        const double range = std::max(histogram.values.back() - histogram.values.front(), 1e-300);
        for (std::size_t i = 0; i < size_; ++i) {
            const auto count = static_cast<double>(histogram.counts[i]);
            const double value = (histogram.values[i] - middle) / range;
            count_.push_back(count_.back() + count);
            sum_.push_back(sum_.back() + count * value);
            squares_.push_back(squares_.back() + count * value * value);
        }
    }

    double range_cost(std::size_t begin, std::size_t end) const {
        const double sum = sum_[end] - sum_[begin];
        return std::max(0.0, squares_[end] - squares_[begin] - sum * sum / (count_[end] - count_[begin]));
    }

    /// Fills next_cost_ and the last cut for ends in [low, high]; the cuts are within [cut_low, cut_high].
    void fill(std::size_t low, std::size_t high, std::size_t cut_low, std::size_t cut_high) {
        if (low > high) return;
        const std::size_t middle = low + (high - low) / 2;
        std::size_t best_cut = cut_low;
        for (std::size_t cut = cut_low; cut <= std::min(cut_high, middle - 1); ++cut) {
            const double cost = cost_[cut] + range_cost(cut, middle);
            if (cost < next_cost_[middle]) {
                next_cost_[middle] = cost;
                best_cut = cut;
            }
        }
        last_cut_.back()[middle] = static_cast<std::uint32_t>(best_cut);
        if (middle > low) fill(low, middle - 1, cut_low, best_cut);
        fill(middle + 1, high, best_cut, cut_high);
    }

    std::size_t size_;
    std::vector<double> count_, sum_, squares_;  ///< prefix sums over the different values
    std::vector<double> cost_, next_cost_;       ///< [end] of the best cut into the bins so far
    std::vector<Bins> last_cut_;                 ///< [bin - 1][end] where the last bin begins
};

Bins kmeans_bins(std::span<const double> values, std::uint32_t bins) {
    if (bins > kMaxKmeansBins)
        fail_usage("binning by k-means takes at most " + std::to_string(kMaxKmeansBins) + " bins, not " +
                   std::to_string(bins));
    const Histogram histogram = histogram_of(values);
    const auto possible = static_cast<std::uint32_t>(std::min<std::size_t>(bins, histogram.values.size()));
    return spread(values, histogram, OptimalCuts(histogram, possible).bin_of_different());
}

/// Renumbers the used bins 0, 1, ... in their order.
void drop_empty(Bins& bin_of) {
    Bins used = bin_of;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t& bin : bin_of)
        bin = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), bin) - used.begin());
}

}  // namespace

std::vector<std::uint32_t> bin_values(std::span<const double> youngs_modulus_pa, std::uint32_t bins,
                                      Binning binning) {
    if (bins == 0) fail_usage("the number of bins must be at least 1");
    Bins bin_of;
    switch (binning) {
        case Binning::equal_width:
            bin_of = equal_width(youngs_modulus_pa, bins);
            break;
        case Binning::equal_population:
            bin_of = equal_population(youngs_modulus_pa, bins);
            break;
        case Binning::equal_width_log:
            bin_of = equal_width_log(youngs_modulus_pa, bins);
            break;
        case Binning::kmeans:
            bin_of = kmeans_bins(youngs_modulus_pa, bins);
            break;
    }
    drop_empty(bin_of);
    return bin_of;
}

}  // namespace knead::tools
