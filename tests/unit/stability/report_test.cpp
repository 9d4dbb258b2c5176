// SPDX-License-Identifier: Apache-2.0
#include "stability/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <set>

namespace knead::tools::stability {
namespace {

TEST(StabilityMatrix, Has_at_least_120_cells_with_names_of_their_own) {
    const std::vector<std::string> names = stability_cells();
    EXPECT_GE(names.size(), 120U);
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(StabilityWarnings, Have_a_cause_an_advice_and_a_place_in_the_documentation) {
    std::ifstream stream(KNEAD_DOCS "/stability.md");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    ASSERT_FALSE(text.empty());
    for (const Warning warning : all_warnings()) {
        EXPECT_STRNE(advice_for(warning).cause, "") << name_of(warning);
        EXPECT_STRNE(advice_for(warning).action, "") << name_of(warning);
        EXPECT_THAT(text, testing::HasSubstr("| `" + std::string(name_of(warning)) + "` |"));
    }
}

CellResult cell_with(CellStatus status, Warning warning) {
    CellResult cell;
    cell.name = "family/case";
    cell.family = "family";
    cell.checks = {
        {"good", 0.5, 1, "m", CellStatus::pass, Warning::none, ""},
        {"other", 2, 1, "s", status, warning, "two of one"},
        {"unknown", std::numeric_limits<double>::quiet_NaN(), 1, "s", CellStatus::pass, Warning::none, ""}};
    return cell;
}

TEST(StabilityReport, Json_names_the_check_that_decided_with_its_number_reason_and_advice) {
    const auto json = stability_json({cell_with(CellStatus::warn, Warning::locking)}, {{}, "abc", "command"});
    EXPECT_EQ(json["schema"], "knead-stability/1");
    EXPECT_EQ(json["commit"], "abc");
    EXPECT_EQ(json["counts"]["warn"], 1);
    const auto& cell = json["cells"][0];
    EXPECT_EQ(cell["case"], "family/case");
    EXPECT_EQ(cell["status"], "warn");
    EXPECT_EQ(cell["value"], 2);
    EXPECT_EQ(cell["bound"], 1);
    EXPECT_EQ(cell["unit"], "s");
    EXPECT_EQ(cell["reason"], "locking: two of one");
    EXPECT_EQ(cell["advice"], advice_for(Warning::locking).action);
    EXPECT_TRUE(cell["checks"]["unknown"]["value"].is_null());
}

TEST(StabilityReport, Good_cell_shows_what_it_is_about) {
    const auto json = stability_json({cell_with(CellStatus::pass, Warning::none)}, {});
    EXPECT_EQ(json["cells"][0]["check"], "good");
    EXPECT_EQ(json["cells"][0]["reason"], "");
}

TEST(StabilityReport, Table_counts_passes_warnings_and_fails) {
    EXPECT_THAT(stability_table(
                    {cell_with(CellStatus::pass, Warning::none), cell_with(CellStatus::fail, Warning::none)}),
                testing::HasSubstr("2 cells: 1 pass, 0 with a warning, 1 fail"));
}

}  // namespace
}  // namespace knead::tools::stability
