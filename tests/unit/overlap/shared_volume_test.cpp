// SPDX-License-Identifier: Apache-2.0
#include "overlap/shared_volume.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "overlap/exact.h"
#include "unit/overlap/exact_oracle.h"
#include "unit/overlap/tet_pairs.h"

namespace knead::test {
namespace {

using tools::ArithmeticCounts;
using tools::prepare;
using tools::PreparedTet;

constexpr int kPairsOfEachKind = 200;
/// What shared_volume() promises, of the smaller volume.
constexpr double kPromised = tools::kSharedVolumeAccuracy;

double shared(const TetPair& pair, ArithmeticCounts& counts) {
    return tools::shared_volume(prepare(pair.first), prepare(pair.second), counts);
}

double smaller_volume(const TetPair& pair) {
    return std::min(exact_volume(pair.first), exact_volume(pair.second));
}

class SharedVolume : public testing::TestWithParam<PairKind> {};

TEST_P(SharedVolume, of_two_tetrahedra_agrees_with_exact_arithmetic_to_the_promised_accuracy) {
    ArithmeticCounts counts;
    double worst = 0;
    int sharing = 0;
    for (const TetPair& pair : make_pairs(GetParam(), kPairsOfEachKind)) {
        const double expected = exact_shared_volume(pair.first, pair.second);
        const double volume = shared(pair, counts);
        if (expected == 0) {
            EXPECT_EQ(volume, 0) << "the two only touch";
        }
        worst = std::max(worst, std::abs(volume - expected) / smaller_volume(pair));
        sharing += expected > 0 ? 1 : 0;
    }
    EXPECT_LE(worst, kPromised);
    EXPECT_GT(sharing, kPairsOfEachKind / 20) << "the pairs hardly test anything";
    RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
    RecordProperty("in_long_double", static_cast<int>(counts.in_long_double));
    RecordProperty("exact", static_cast<int>(counts.exact));
}

TEST_P(SharedVolume, of_two_tetrahedra_does_not_depend_on_their_order) {
    for (const auto& [a, b] : make_pairs(GetParam(), kPairsOfEachKind)) {
        ArithmeticCounts counts;
        const double forth = shared({a, b}, counts);
        const double back = shared({b, a}, counts);
        EXPECT_NEAR(forth, back, kPromised * std::min(prepare(a).volume, prepare(b).volume));
    }
}

TEST_P(SharedVolume, in_exact_arithmetic_of_the_tool_agrees_with_the_oracle) {
    constexpr int kFew = 20;  // the tool's own exact path, which ordinary pairs do not reach
    for (const auto& [a, b] : make_pairs(GetParam(), kFew)) {
        const double volume = exact_volume(a);
        EXPECT_DOUBLE_EQ(tools::exact_volume(a), volume);
        EXPECT_NEAR(tools::exact_share(a, b) * volume, exact_shared_volume(a, b), 1e-15 * volume);
    }
}

INSTANTIATE_TEST_SUITE_P(pairs, SharedVolume, testing::ValuesIn(all_pair_kinds()),
                         [](const auto& pair) { return name_of(pair.param); });

TEST(SharedVolume_arithmetic, is_double_for_ordinary_pairs_and_better_only_where_it_must_be) {
    ArithmeticCounts ordinary;
    for (const TetPair& pair : make_pairs(PairKind::coplanar_lattice, kPairsOfEachKind))
        shared(pair, ordinary);
    EXPECT_GT(ordinary.in_double, static_cast<std::uint64_t>(kPairsOfEachKind) * 9 / 10);

    ArithmeticCounts slivers;
    for (const TetPair& pair : make_pairs(PairKind::sliver, kPairsOfEachKind))
        shared(pair, slivers);
    EXPECT_GT(slivers.in_double, 0U);
    EXPECT_GT(slivers.in_long_double, 0U);
    EXPECT_GT(slivers.exact, 0U);
    EXPECT_EQ(slivers.in_double + slivers.in_long_double + slivers.exact,
              static_cast<std::uint64_t>(kPairsOfEachKind));
}

TEST(SharedVolume_of_prepared_tetrahedron, has_an_accurate_volume_even_for_slivers) {
    constexpr double kVolumeAccuracy = 4e-13;  // as prepared_tet.h promises
    for (const auto& [a, b] : make_pairs(PairKind::sliver, kPairsOfEachKind)) {
        const double exact = exact_volume(a);
        EXPECT_NEAR(prepare(a).volume, exact, kVolumeAccuracy * exact);
    }
}

TEST(SharedVolume_of_known_shapes, is_what_geometry_says) {
    const Corners unit{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const Corners half{{{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}};
    const Corners below{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}}};
    const Corners mirrored{{{0, 0, 0.5}, {0, 1, 0.5}, {1, 0, 0.5}, {0, 0, -0.5}}};
    ArithmeticCounts counts;
    EXPECT_DOUBLE_EQ(shared({unit, unit}, counts), 1.0 / 6);
    EXPECT_DOUBLE_EQ(shared({unit, half}, counts), 1.0 / 48);
    EXPECT_EQ(shared({unit, below}, counts), 0);
    // Two edges that cross in one point: no face plane separates the two.
    const Corners roof{{{-1, 0, 0}, {1, 0, 0}, {0.1, -1, -1}, {-0.2, 1, -1}}};
    const Corners keel{{{0, -1, 0}, {0, 1, 0}, {1, 0.3, 1}, {-1, 0.4, 1}}};
    EXPECT_EQ(shared({roof, keel}, counts), 0);
    // Two cross sections (1-z)^2/2 and (z+1/2)^2/2 for 0 < z < 1/2, the smaller of which counts.
    EXPECT_NEAR(shared({unit, mirrored}, counts), 2 * (0.75 * 0.75 * 0.75 - 0.5 * 0.5 * 0.5) / 6, 1e-16);
}

}  // namespace
}  // namespace knead::test
