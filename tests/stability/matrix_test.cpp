// SPDX-License-Identifier: Apache-2.0
// The stability matrix (docs/stability.md), shortened: each family a test.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "stability/report.h"
#include "stability/stability.h"

namespace knead::tools::stability {
namespace {

/// Cells that fail, why in docs/stability.md. One that does not fail any more is to be taken off the list.
const std::map<std::string, std::string>& known_faults() {
    static const std::map<std::string, std::string> faults{
        {"fast/bonded plate teleported by -1000 %", "does not come to rest"},
    };
    return faults;
}

class StabilityFamily : public testing::TestWithParam<const char*> {};

TEST_P(StabilityFamily, Has_no_cell_that_fails) {
    StabilityRequest request;
    request.pattern = std::string(GetParam()) + "/";
    request.shortened = true;
    const std::vector<CellResult> cells = run_stability(request);
    ASSERT_FALSE(cells.empty());
    for (const CellResult& cell : cells) {
        const bool known = known_faults().count(cell.name) > 0;
        if (known)
            EXPECT_EQ(cell.status(), CellStatus::fail) << cell.name << ": mended; take it off the list";
        else
            EXPECT_NE(cell.status(), CellStatus::fail) << stability_table({cell});
    }
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
