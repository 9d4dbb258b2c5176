// SPDX-License-Identifier: Apache-2.0
#include "cluster/binning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <random>

#include "common/error.h"

namespace knead::test {
namespace {

using testing::ElementsAre;
using namespace tools;

TEST(Binning, Equal_width_cuts_the_range_and_closes_the_last_bin) {
    const std::vector<double> values{0.5, 1.0, 2.4, 2.6, 4.4, 4.5};  // [0.5, 2.5), [2.5, 4.5]
    EXPECT_THAT(bin_values(values, 2, Binning::equal_width), ElementsAre(0, 0, 0, 1, 1, 1));
    const std::vector<double> on_the_edge{0, 1, 2, 3, 4};  // 2 is the low end of the second bin
    EXPECT_THAT(bin_values(on_the_edge, 2, Binning::equal_width), ElementsAre(0, 0, 1, 1, 1));
}

TEST(Binning, Empty_bins_are_dropped_and_the_rest_renumbered_soft_to_stiff) {
    const std::vector<double> values{42e3, 2e3, 38e3, 6e3};
    EXPECT_THAT(bin_values(values, 20, Binning::equal_width), ElementsAre(3, 0, 2, 1));
    const std::vector<double> far{1, 1000, 1.5};
    EXPECT_THAT(bin_values(far, 100, Binning::equal_width), ElementsAre(0, 1, 0));
}

TEST(Binning, One_value_gives_one_bin_whatever_the_rule) {
    const std::vector<double> values(5, 7.0);
    for (const Binning how :
         {Binning::equal_width, Binning::equal_population, Binning::equal_width_log, Binning::kmeans})
        EXPECT_THAT(bin_values(values, 3, how), ElementsAre(0, 0, 0, 0, 0));
}

TEST(Binning, Equal_population_fills_bins_evenly_and_keeps_equal_values_together) {
    const std::vector<double> values{6, 5, 4, 3, 2, 1};
    EXPECT_THAT(bin_values(values, 3, Binning::equal_population), ElementsAre(2, 2, 1, 1, 0, 0));
    const std::vector<double> tied{1, 1, 1, 1, 2, 3};
    EXPECT_THAT(bin_values(tied, 3, Binning::equal_population), ElementsAre(0, 0, 0, 0, 1, 1));
}

TEST(Binning, Equal_width_in_the_logarithm_separates_decades) {
    const std::vector<double> values{1e3, 2e3, 5e4, 8e4, 2e6, 1e6};
    EXPECT_THAT(bin_values(values, 3, Binning::equal_width_log), ElementsAre(0, 0, 1, 1, 2, 2));
    EXPECT_THAT(bin_values(values, 3, Binning::equal_width), ElementsAre(0, 0, 0, 0, 2, 1));
}

double cost_of(const std::vector<double>& values, const std::vector<std::uint32_t>& bins) {
    std::map<std::uint32_t, std::vector<double>> groups;
    for (std::size_t i = 0; i < values.size(); ++i)
        groups[bins[i]].push_back(values[i]);
    double cost = 0;
    for (const auto& [bin, group] : groups) {
        double mean = 0;
        for (const double value : group)
            mean += value / static_cast<double>(group.size());
        for (const double value : group)
            cost += (value - mean) * (value - mean);
    }
    return cost;
}

/// The smallest cost over every assignment of the values to `bins` bins.
double cheapest(const std::vector<double>& values, std::uint32_t bins) {
    std::vector<std::uint32_t> assignment(values.size(), 0);
    double best = std::numeric_limits<double>::infinity();
    while (true) {
        best = std::min(best, cost_of(values, assignment));
        std::size_t digit = 0;
        while (digit < assignment.size() && ++assignment[digit] == bins)
            assignment[digit++] = 0;
        if (digit == assignment.size()) return best;
    }
}

TEST(Binning, Kmeans_reaches_the_optimum_of_all_assignments) {
    std::mt19937_64 engine(3);
    for (int round = 0; round < 100; ++round) {
        std::vector<double> values;
        for (int i = 0; i < 7; ++i)
            values.push_back(static_cast<double>(1 + engine() % 50));
        for (const std::uint32_t bins : {2U, 3U}) {
            const double best = cheapest(values, bins);
            // Both are sums of the same few squares in other orders.
            EXPECT_NEAR(cost_of(values, bin_values(values, bins, Binning::kmeans)), best, 1e-9 * (1 + best));
        }
    }
}

TEST(Binning, Bins_are_numbered_from_soft_to_stiff_whatever_the_rule) {
    std::mt19937_64 engine(9);
    std::vector<double> values;
    for (int i = 0; i < 500; ++i)
        values.push_back(1e3 + static_cast<double>(engine() % 100000));
    for (const Binning how :
         {Binning::equal_width, Binning::equal_population, Binning::equal_width_log, Binning::kmeans}) {
        const auto bins = bin_values(values, 6, how);
        for (std::size_t i = 0; i < values.size(); ++i)
            for (std::size_t j = 0; j < values.size(); ++j)
                ASSERT_TRUE(values[i] > values[j] || bins[i] <= bins[j]);
        EXPECT_EQ(*std::max_element(bins.begin(), bins.end()), 5U);
    }
}

TEST(Binning, No_bins_is_bad_usage) {
    const std::vector<double> values{1, 2};
    EXPECT_THROW((void)bin_values(values, 0, Binning::equal_width), ToolError);
    EXPECT_THROW((void)bin_values(values, kMaxKmeansBins + 1, Binning::kmeans), ToolError);
}

TEST(Binning, Many_more_bins_than_values_is_fine) {
    const std::vector<double> values{1, 3, 2};
    EXPECT_THAT(bin_values(values, UINT32_MAX, Binning::equal_width), ElementsAre(0, 2, 1));
    EXPECT_THAT(bin_values(values, 256, Binning::kmeans), ElementsAre(0, 2, 1));
}

}  // namespace
}  // namespace knead::test
