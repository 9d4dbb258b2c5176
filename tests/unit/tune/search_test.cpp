// SPDX-License-Identifier: Apache-2.0
#include "tune/search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace knead::tools {
namespace {

constexpr std::size_t kLoads = 4;  // the last one is held out
constexpr double kWithin = 0.1;
constexpr std::uint32_t kFresh = 3;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Made-up levels: every error is a pure function of (candidate, seed, load), known to the test too.
struct MadeUp {
    explicit MadeUp(std::uint64_t draw) : random(draw) {
        for (std::size_t mesh = 0; mesh < 4; ++mesh) {
            SearchMesh made{10.0 + static_cast<double>(random() % 40), {}, false};
            for (int k = 0; k < 5; ++k) {
                made.candidates.push_back(scales.size());
                mesh_of.push_back(mesh);
                // From hopeless to flawless, and on the edge in between.
                scales.push_back(0.02 + 0.02 * static_cast<double>(random() % 12));
            }
            space.meshes.push_back(made);
        }
        space.within = kWithin;
        space.budget_us = 35;
        space.choosing_seeds = {5, 6};
        space.fresh_seeds = kFresh;
        space.looks_on_a_mesh = 2;
        space.chosen_loads = {2, 0, 1};
        space.proven_loads = {0, 1, 2, 3};
        space.error = [this](std::size_t candidate, std::uint64_t seed, std::size_t load) {
            const std::lock_guard lock(mutex);
            asked.insert({candidate, seed, load});
            return error(candidate, seed, load);
        };
        space.step_us = [this](std::size_t candidate) { return space.meshes[mesh_of[candidate]].step_us; };
        space.depends_on_seed = [](std::size_t) { return true; };
    }

    [[nodiscard]] double error(std::size_t candidate, std::uint64_t seed, std::size_t load) const {
        std::mt19937_64 own(candidate * 1000 + seed * 10 + load);
        const double share = static_cast<double>(own() >> 11) / 9007199254740992.0;
        return scales[candidate] * (2 * share - 1);
    }
    [[nodiscard]] double worst(std::size_t candidate, const std::vector<std::uint64_t>& seeds,
                               const std::vector<std::size_t>& loads) const {
        double largest = 0;
        for (const std::uint64_t seed : seeds)
            for (const std::size_t load : loads)
                largest = std::max(largest, std::abs(error(candidate, seed, load)));
        return largest;
    }

    std::mt19937_64 random;
    SearchSpace space;
    std::vector<std::size_t> mesh_of;
    std::vector<double> scales;
    std::mutex mutex;
    std::set<std::tuple<std::size_t, std::uint64_t, std::size_t>> asked;
};

/// The answer by looking at everything: no giving up, no order of loads.
std::optional<std::size_t> by_brute_force(const MadeUp& made) {
    std::vector<std::size_t> meshes(made.space.meshes.size());
    std::iota(meshes.begin(), meshes.end(), 0);
    std::stable_sort(meshes.begin(), meshes.end(), [&](std::size_t a, std::size_t b) {
        return made.space.meshes[a].step_us < made.space.meshes[b].step_us;
    });
    std::uint64_t fresh = 7;
    for (const std::size_t mesh : meshes) {
        if (made.space.meshes[mesh].step_us > made.space.budget_us) break;
        std::vector<std::pair<double, std::size_t>> holding;
        for (const std::size_t c : made.space.meshes[mesh].candidates)
            if (const double w = made.worst(c, {5, 6}, {0, 1, 2}); w <= kWithin) holding.emplace_back(w, c);
        std::sort(holding.begin(), holding.end());
        if (holding.size() > 2) holding.resize(2);
        for (const auto& [w, c] : holding) {
            const std::vector<std::uint64_t> seeds{fresh, fresh + 1, fresh + 2};
            fresh += kFresh;
            if (made.worst(c, seeds, {0, 1, 2, 3}) <= kWithin) return c;
        }
    }
    return std::nullopt;
}

class RandomSpace : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomSpace, Search_finds_what_looking_at_everything_finds) {
    MadeUp made(GetParam());
    const SearchOutcome outcome = search(made.space);
    const auto expected = by_brute_force(made);
    ASSERT_EQ(outcome.found.has_value(), expected.has_value());
    if (expected) {
        EXPECT_EQ(outcome.found->candidate, *expected);
    }
}

TEST_P(RandomSpace, Verified_level_holds_on_every_load_and_fresh_seed_and_no_seed_serves_twice) {
    MadeUp made(GetParam());
    const SearchOutcome outcome = search(made.space);
    std::set<std::uint64_t> used{5, 6};
    for (const Look& look : outcome.looks)
        for (std::uint64_t seed = look.first_seed; seed < look.first_seed + kFresh; ++seed)
            EXPECT_TRUE(used.insert(seed).second) << seed;
    if (!outcome.found) return;
    const std::uint64_t first = outcome.found->first_seed;
    EXPECT_LE(made.worst(outcome.found->candidate, {first, first + 1, first + 2}, {0, 1, 2, 3}), kWithin);
    EXPECT_EQ(outcome.found->worst.answers, kFresh * kLoads);
}

TEST_P(RandomSpace, Held_out_load_is_never_asked_of_a_choosing_seed) {
    MadeUp made(GetParam());
    (void)search(made.space);
    for (const auto& [candidate, seed, load] : made.asked)
        if (seed <= 6) {
            EXPECT_NE(load, 3u) << candidate;
        }
}

TEST_P(RandomSpace, Nothing_within_gives_the_candidate_in_time_with_the_least_worst_error) {
    MadeUp made(GetParam());
    made.space.within = 0.005;  // below what any of them reaches
    const SearchOutcome outcome = search(made.space);
    ASSERT_FALSE(outcome.found);
    double least = kNever;
    for (const SearchMesh& mesh : made.space.meshes)
        if (mesh.step_us <= made.space.budget_us)
            for (const std::size_t c : mesh.candidates)
                least = std::min(least, made.worst(c, {5, 6}, {0, 1, 2}));
    ASSERT_EQ(outcome.nearest_in_time.has_value(), std::isfinite(least));
    if (outcome.nearest_in_time) {
        EXPECT_EQ(outcome.nearest_in_time->worst.size(), least);
    }
}

TEST_P(RandomSpace, Candidate_is_given_up_at_its_first_error_beyond) {
    MadeUp made(GetParam());
    const SearchOutcome outcome = search(made.space);
    if (!outcome.found) return;  // else the search for the nearest looks on
    for (const Trial& trial : outcome.trials) {
        if (trial.holds) continue;
        const std::size_t at = trial.worst.answers - 1;  // the last one looked at is the one that failed
        EXPECT_EQ(trial.worst.seed, made.space.choosing_seeds[at / 3]);
        EXPECT_EQ(trial.worst.load, made.space.chosen_loads[at % 3]);
        EXPECT_GT(trial.worst.size(), kWithin);
    }
}

INSTANTIATE_TEST_SUITE_P(Draws, RandomSpace, testing::Range<std::uint64_t>(1, 21));

/// One mesh in time of which nothing holds, and the fine one, which is exact.
void add_fine(MadeUp& made, double fine_us) {
    made.space.meshes.resize(1);
    made.space.meshes[0].step_us = 20;
    made.space.meshes.push_back({fine_us, {made.scales.size()}, true});
    std::fill(made.mesh_of.begin(), made.mesh_of.end(), 0);
    made.mesh_of.push_back(1);
    made.scales.push_back(0);
    made.space.within = 0.001;
}

TEST(Search, Fine_mesh_in_time_is_the_last_answer_and_needs_no_proof) {
    MadeUp made(3);
    add_fine(made, 30);
    const SearchOutcome outcome = search(made.space);
    ASSERT_TRUE(outcome.found);
    EXPECT_EQ(outcome.found->mesh, 1u);
    EXPECT_EQ(outcome.found->worst.answers, 0u);
}

TEST(Search, Fine_mesh_over_the_budget_is_what_is_within_and_fastest) {
    MadeUp made(3);
    add_fine(made, 50);
    const SearchOutcome outcome = search(made.space);
    EXPECT_FALSE(outcome.found);
    ASSERT_TRUE(outcome.nearest_within);
    EXPECT_EQ(outcome.nearest_within->mesh, 1u);
    ASSERT_TRUE(outcome.nearest_in_time);
    EXPECT_EQ(outcome.nearest_in_time->mesh, 0u);
}

TEST(Search, Level_that_is_too_slow_when_timed_itself_is_not_the_answer) {
    MadeUp made(3);
    add_fine(made, 30);
    made.space.step_us = [](std::size_t) { return 36.0; };
    const SearchOutcome outcome = search(made.space);
    EXPECT_FALSE(outcome.found);
    ASSERT_EQ(outcome.looks.size(), 1u);
    EXPECT_FALSE(outcome.looks[0].is_in_time);
    ASSERT_TRUE(outcome.nearest_within);
    EXPECT_EQ(outcome.nearest_within->mesh, 1u);
}

TEST(Search, Load_without_rest_is_beyond_every_limit) {
    MadeUp made(3);
    made.space.within = 1;
    made.space.error = [](std::size_t, std::uint64_t, std::size_t) { return kNever; };
    const SearchOutcome outcome = search(made.space);
    EXPECT_FALSE(outcome.found);
    EXPECT_FALSE(outcome.nearest_in_time);  // no candidate has an error to be near by
}

TEST(Search, Level_that_no_seed_changes_is_chosen_and_verified_on_one_seed) {
    MadeUp made(3);
    made.space.within = 1;
    made.space.depends_on_seed = [](std::size_t) { return false; };
    const SearchOutcome outcome = search(made.space);
    ASSERT_TRUE(outcome.found);
    EXPECT_EQ(outcome.found->first_seed, 5u);
    EXPECT_EQ(outcome.found->seeds, 1u);
    EXPECT_EQ(outcome.found->worst.answers, kLoads);
}

}  // namespace
}  // namespace knead::tools
