// SPDX-License-Identifier: Apache-2.0
// Runs `knead-bench --quick` once and looks at what it wrote. Nothing here depends on time.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/allocation.h"

namespace knead::bench {
namespace {

using nlohmann::json;

json run_quick() {
    const auto file = std::filesystem::path(testing::TempDir()) / "knead-bench-quick.json";
    const std::string command =
        std::string(KNEAD_BIN) + "/knead-bench --quick --json \"" + file.string() + "\" > /dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::ifstream in(file);
    json document = json::parse(in, nullptr, false);
    std::filesystem::remove(file);
    return document;
}

/// Numbers that were not finite have become null.
void expect_no_null(const json& value, const std::string& where) {
    EXPECT_FALSE(value.is_null()) << where;
    if (!value.is_structured()) return;
    for (const auto& [key, item] : value.items())
        expect_no_null(item, where + "/" + key);
}

constexpr std::array kStepNumbers{
    "tets",           "us_min",   "us_p50",  "us_p99",      "us_p999",     "baseline_us_p50", "ratio",
    "pcg_iterations", "bound_us", "load_ms", "force_error", "allocations", "trajectory_error"};
// The guard aims at 1e-4; a whole motion may add up several.
constexpr double kForceError = 1e-3;

TEST(QuickBench, Writes_its_schema_with_finite_numbers_and_right_forces) {
    const json report = run_quick();
    ASSERT_TRUE(report.is_object());
    expect_no_null(report, "");
    EXPECT_EQ(report["schema"], "knead-bench/1");
    for (const char* key : {"cpu", "isa", "compiler", "flags", "os"})
        EXPECT_FALSE(report["machine"].value(key, "").empty()) << key;
    EXPECT_EQ(report["command"].get<std::string>().rfind("knead-bench --quick", 0), 0U);
    ASSERT_EQ(report["steps"].size(), 2U);
    for (const json& row : report["steps"]) {
        for (const char* key : kStepNumbers)
            EXPECT_TRUE(row.contains(key) && row[key].is_number()) << key;
        EXPECT_GT(row["bound_us"], 0);
        EXPECT_EQ(row["allocations"], 0);
        EXPECT_EQ(row["repeatable"], true);
        EXPECT_EQ(row["simulation_bytes"] > 0, kAllocationsAreCounted);
        EXPECT_LT(row["force_error"], kForceError);
        EXPECT_LT(row["baseline_force_error"], kForceError);
    }
    EXPECT_FALSE(report["hard_cases"].empty());
    for (const json& row : report["hard_cases"])
        EXPECT_EQ(row["pass"], true) << row["name"];
    EXPECT_GE(report["leave_out"].size(), 3U);
    ASSERT_EQ(report["haptic_cycle"].size(), 4U);
    for (const json& row : report["haptic_cycle"])
        EXPECT_GT(row["us_p50"], 0) << row["rendering"];
}

}  // namespace
}  // namespace knead::bench
