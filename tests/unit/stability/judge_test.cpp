// SPDX-License-Identifier: Apache-2.0
#include "stability/judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "stability/criteria.h"

namespace knead::tools::stability {
namespace {

/// A run in which everything is well.
Record good_run() {
    Record record;
    record.steps = 1000;
    record.mean_iterations = 2;
    record.largest_force_n = 10;
    record.against_linearised = {{1e-4, 10, false}, {1e-4, 5, false}};
    record.against_converged = {{1e-3, 10, false}};
    record.at_rest = ForceSample{1e-4, 8, false};
    record.energy_over_work = 0.9;
    record.energy_over_net_work = -0.1;
    record.off_rest = 1e-7;
    record.touching_steps = 500;
    return record;
}

CellResult judged(const Record& record, Demands demands = {}) {
    CellResult cell;
    cell.checks = judge(record, demands, 0.1);
    return cell;
}

TEST(Judge, Run_in_which_everything_is_well_passes) {
    EXPECT_EQ(judged(good_run()).status(), CellStatus::pass);
}

TEST(Judge, Wrong_force_told_as_right_fails) {
    Record record = good_run();
    record.against_linearised[1].difference_n = 1.1 * criteria::kForceWrong * 5;
    EXPECT_EQ(judged(record).status(), CellStatus::fail);
    EXPECT_EQ(judged(record).decisive().name, "step_force");
}

TEST(Judge, Wrong_force_of_a_step_that_told_it_does_not_fail) {
    Record record = good_run();
    record.against_linearised[1] = {3, 5, true};
    record.not_converged = 1;
    const CellResult cell = judged(record);
    EXPECT_EQ(cell.status(), CellStatus::warn);
    EXPECT_EQ(cell.warnings(), std::vector<Warning>{Warning::not_converged});
}

TEST(Judge, Force_between_good_and_wrong_warns) {
    Record record = good_run();
    record.against_linearised[0].difference_n = 0.5 * criteria::kForceWrong * 10;
    EXPECT_EQ(judged(record).warnings(), std::vector<Warning>{Warning::step_force});
    record = good_run();
    record.at_rest->difference_n = 0.5 * criteria::kForceWrong * 8;
    EXPECT_EQ(judged(record).warnings(), std::vector<Warning>{Warning::force_at_rest});
}

TEST(Judge, Wrong_force_at_rest_fails) {
    Record record = good_run();
    record.at_rest->difference_n = 0.1;
    EXPECT_EQ(judged(record).decisive().name, "force_at_rest");
    EXPECT_EQ(judged(record).status(), CellStatus::fail);
}

TEST(Judge, Force_that_is_not_finite_is_wrong) {
    Record record = good_run();
    record.against_linearised[0].difference_n = std::numeric_limits<double>::infinity();
    EXPECT_EQ(judged(record).status(), CellStatus::fail);
    record = good_run();
    record.finite = false;
    EXPECT_EQ(judged(record).decisive().name, "finite");
}

TEST(Judge, Small_force_is_measured_against_a_share_of_the_largest) {
    Record record = good_run();
    record.against_linearised.push_back(
        {0.5 * criteria::kForceGood * criteria::kSmallestForceShare * 10, 0, false});
    EXPECT_EQ(judged(record).status(), CellStatus::pass);
}

TEST(Judge, Step_far_from_the_converged_one_warns_of_the_linearisation) {
    Record record = good_run();
    record.against_converged[0].difference_n = 1;
    EXPECT_EQ(judged(record).warnings(), std::vector<Warning>{Warning::linearisation});
}

TEST(Judge, Run_without_any_comparison_says_so) {
    Record record = good_run();
    record.against_linearised.clear();
    EXPECT_EQ(judged(record).warnings(), std::vector<Warning>{Warning::no_reference});
}

struct Bad {
    const char* check;
    void (*spoil)(Record&);
};
void PrintTo(const Bad& bad, std::ostream* out) {
    *out << bad.check;
}

class Spoilt : public testing::TestWithParam<Bad> {};

TEST_P(Spoilt, Run_fails_by_the_check_that_is_about_it) {
    Record record = good_run();
    GetParam().spoil(record);
    Demands demands;
    demands.contact_law = demands.soak = true;
    const CellResult cell = judged(record, demands);
    EXPECT_EQ(cell.status(), CellStatus::fail);
    const auto check = std::find_if(cell.checks.begin(), cell.checks.end(),
                                    [](const Check& c) { return c.name == GetParam().check; });
    ASSERT_NE(check, cell.checks.end());
    EXPECT_EQ(check->status, CellStatus::fail);
    EXPECT_FALSE(check->note.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Each, Spoilt,
    testing::Values(Bad{"finite", [](Record& r) { r.not_finite = 1; }},
                    Bad{"bounded", [](Record& r) { r.energy_over_work = 1.03; }},
                    Bad{"passive", [](Record& r) { r.energy_over_net_work = 0.03; }},
                    Bad{"drift", [](Record& r) { r.growth_while_still = 2e-3; }},
                    Bad{"recovery", [](Record& r) { r.off_rest = 2e-4; }},
                    Bad{"recovery", [](Record& r) { r.off_rest = std::numeric_limits<double>::quiet_NaN(); }},
                    Bad{"not_converged", [](Record& r) { r.not_converged = 200; }},
                    Bad{"contact_cap", [](Record& r) { r.contact_cap = 200; }},
                    Bad{"bad_input", [](Record& r) { r.bad_input = 1; }},
                    Bad{"touches", [](Record& r) { r.touching_steps = 0; }},
                    Bad{"pull", [](Record& r) { r.strongest_pull_n = 1; }},
                    Bad{"cone", [](Record& r) { r.cone_excess_n = 1; }},
                    Bad{"penetration", [](Record& r) { r.deepest_m = 1e-3; }},
                    Bad{"force_away", [](Record& r) { r.force_away_n = 1e-6; }},
                    Bad{"force_growth",
                        [](Record& r) {
                            r.first_tenth_force_n = 1;
                            r.last_tenth_force_n = 1.02;
                        }},
                    Bad{"energy_growth", [](Record& r) { r.last_tenth_energy_j = 1; }}));

TEST(Judge, Many_iterations_warn) {
    Record record = good_run();
    record.mean_iterations = 31;
    EXPECT_EQ(judged(record).warnings(), std::vector<Warning>{Warning::iterations});
}

TEST(Judge, Tool_that_left_with_nodes_on_it_warns_instead_of_judging_recovery) {
    Record record = good_run();
    record.touches_at_end = true;
    record.off_rest = 1;
    Demands demands;
    demands.contact_law = true;
    EXPECT_EQ(judged(record, demands).warnings(), std::vector<Warning>{Warning::hooked});
}

TEST(Judge, Matter_that_was_told_to_be_inside_out_warns_however_long) {
    Record record = good_run();
    record.inside_out = record.steps;
    EXPECT_EQ(judged(record).warnings(), std::vector<Warning>{Warning::inside_out});
    record.at_rest = ForceSample{4, 8, true};
    EXPECT_EQ(judged(record).warnings(), std::vector<Warning>{Warning::inside_out});
    record.at_rest->told = false;
    EXPECT_EQ(judged(record).status(), CellStatus::fail);
}

}  // namespace
}  // namespace knead::tools::stability
