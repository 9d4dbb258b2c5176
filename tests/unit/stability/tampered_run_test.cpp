// SPDX-License-Identifier: Apache-2.0
// The whole way from a run to its judgement, with answers of the runtime that are falsified on the way: what
// the matrix must find out.
#include <gtest/gtest.h>

#include <limits>

#include "stability/judge.h"
#include "stability/run.h"

namespace knead::tools::stability {
namespace {

using Tamper = void (*)(std::uint64_t step, ToolResult& tool, std::uint32_t& status);

CellResult pressed(Tamper tamper) {
    const Specimen specimen = plain_cube({}, 2);
    Press press;
    press.way_m = {0, 0, -0.1 * kSide_m};
    const Script script = press_script(specimen, press, 1e-3);
    RunOptions options;
    options.config = config_for(specimen, 1e-3);
    options.compared_steps = 6;
    if (tamper != nullptr) options.tamper = tamper;
    CellResult cell;
    cell.checks = judge(run(specimen, script, options), Demands{}, specimen.size_m);
    return cell;
}

CellStatus status_of(const CellResult& cell, const std::string& name) {
    for (const Check& check : cell.checks)
        if (check.name == name) return check.status;
    ADD_FAILURE() << name << " was not checked";
    return CellStatus::pass;
}

TEST(TamperedRun, Left_alone_passes) {
    const CellResult cell = pressed(nullptr);
    EXPECT_EQ(cell.status(), CellStatus::pass) << cell.decisive().note;
}

TEST(TamperedRun, Force_two_percent_too_large_and_told_as_right_fails) {
    const CellResult cell = pressed([](std::uint64_t, ToolResult& tool, std::uint32_t&) {
        for (double& f : tool.force_n)
            f *= 1.02;
    });
    EXPECT_EQ(status_of(cell, "step_force"), CellStatus::fail);
    EXPECT_EQ(status_of(cell, "force_at_rest"), CellStatus::fail);
}

TEST(TamperedRun, Wrong_force_that_is_told_does_not_fail_as_a_force) {
    const CellResult cell = pressed([](std::uint64_t step, ToolResult& tool, std::uint32_t& status) {
        if (step % 20 != 0) return;
        tool.force_n[2] *= 3;
        status |= kStepNotConverged;
    });
    EXPECT_NE(status_of(cell, "step_force"), CellStatus::fail);
    EXPECT_EQ(status_of(cell, "not_converged"), CellStatus::warn);
}

TEST(TamperedRun, Object_that_always_tells_is_not_usable) {
    const CellResult cell =
        pressed([](std::uint64_t, ToolResult&, std::uint32_t& status) { status |= kStepNotConverged; });
    EXPECT_EQ(status_of(cell, "not_converged"), CellStatus::fail);
}

TEST(TamperedRun, Force_that_pulls_the_hand_on_is_not_passive) {
    const CellResult cell = pressed([](std::uint64_t step, ToolResult& tool, std::uint32_t&) {
        if (step < 90)
            for (double& f : tool.force_n)
                f *= 0.2;
    });
    EXPECT_EQ(status_of(cell, "passive"), CellStatus::fail);
}

TEST(TamperedRun, One_force_that_is_not_a_number_fails) {
    const CellResult cell = pressed([](std::uint64_t step, ToolResult& tool, std::uint32_t&) {
        if (step == 30) tool.force_n[0] = std::numeric_limits<double>::quiet_NaN();
    });
    EXPECT_EQ(status_of(cell, "finite"), CellStatus::fail);
}

}  // namespace
}  // namespace knead::tools::stability
