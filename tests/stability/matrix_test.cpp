// SPDX-License-Identifier: Apache-2.0
// The stability matrix (docs/stability.md), shortened: each family a test.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "stability/report.h"
#include "stability/stability.h"

namespace knead::tools::stability {
namespace {

class StabilityFamily : public testing::TestWithParam<const char*> {};

TEST_P(StabilityFamily, Has_no_cell_that_fails) {
    StabilityRequest request;
    request.pattern = std::string(GetParam()) + "/";
    request.shortened = true;
    const std::vector<CellResult> cells = run_stability(request);
    ASSERT_FALSE(cells.empty());
    for (const CellResult& cell : cells)
        EXPECT_NE(cell.status(), CellStatus::fail) << stability_table({cell});
    const StabilityCounts counts = count_of(cells);
    RecordProperty("pass", static_cast<int>(counts.pass));
    RecordProperty("warn", static_cast<int>(counts.warn));
    RecordProperty("fail", static_cast<int>(counts.fail));
}

INSTANTIATE_TEST_SUITE_P(Matrix, StabilityFamily,
                         testing::Values("contrast", "stiffness", "poisson", "mesh", "size", "mass", "dt",
                                         "large", "fast", "tool", "free", "object", "input", "soak"),
                         [](const auto& family) { return std::string(family.param); });

TEST(StabilityMatrix, Every_cell_belongs_to_a_family_that_is_tested) {
    std::map<std::string, int> families;
    for (const std::string& name : stability_cells())
        ++families[name.substr(0, name.find('/'))];
    EXPECT_EQ(families.size(), 14U);
}

}  // namespace
}  // namespace knead::tools::stability
