// SPDX-License-Identifier: Apache-2.0
#include "quality/step_time.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "unit/runtime/block_asset.h"

namespace knead::tools {
namespace {

/// The documented medians may be measured anew without touching the prediction, as long as they stay near.
constexpr double kStaleFactor = 1.5;

struct Row {
    std::uint32_t tetrahedra = 0;
    double min_us = 0, median_us = 0, p99_us = 0;
};

/// Rows of the table of docs/benchmark.md that has "us/step min" in its head: "| 1,296 | 14.4 | 15.0 | 25.1 |
/// ...".
std::vector<Row> documented_rows() {
    std::ifstream file(std::string(KNEAD_DOCS) + "/benchmark.md");
    std::vector<Row> rows;
    bool in_table = false;
    for (std::string line; std::getline(file, line);) {
        if (line.find("us/step min") != std::string::npos) in_table = true;
        if (line.empty()) in_table = false;
        if (!in_table) continue;
        if (line.rfind("| ", 0) != 0 || line.find_first_of("0123456789") != 2) continue;
        std::string digits;
        for (const char c : line)
            if (c != ',') digits += c == '|' ? ' ' : c;
        std::istringstream numbers(digits);
        Row row;
        if (numbers >> row.tetrahedra >> row.min_us >> row.median_us >> row.p99_us) rows.push_back(row);
    }
    return rows;
}

Asset cube(std::uint32_t cells, const PaletteEntry& material) {
    return test::cube_asset(cells, ToolShape::plate, ToolContact::bonded, material);
}

StepPrediction predicted(const Asset& asset) {
    return predict_step(asset, condition_of(asset));
}

std::uint32_t cells_of(std::uint32_t tetrahedra) {
    std::uint32_t cells = 1;
    while (6 * cells * cells * cells < tetrahedra)
        ++cells;
    return cells;
}

TEST(StepTime, Of_the_documented_cubes_is_near_what_was_measured) {
    const std::vector<Row> rows = documented_rows();
    ASSERT_GE(rows.size(), 4u);
    for (const Row& row : rows) {
        const StepPrediction step = predicted(cube(cells_of(row.tetrahedra), test::kGel));
        EXPECT_LT(step.time_us, kStaleFactor * row.median_us) << row.tetrahedra;
        EXPECT_GT(step.time_us, row.median_us / kStaleFactor) << row.tetrahedra;
        EXPECT_LT(step.low_us, row.min_us) << row.tetrahedra;
        EXPECT_GT(step.high_us, row.p99_us) << row.tetrahedra;
        EXPECT_TRUE(step.calibrated);
    }
}

TEST(StepTime, Grows_with_tetrahedra_and_hardness) {
    const double easy = predicted(cube(6, test::kGel)).time_us;
    EXPECT_LT(predicted(cube(5, test::kGel)).time_us, easy);
    EXPECT_GT(predicted(cube(6, {22e3, 0.49, 1000})).time_us, easy);
    EXPECT_GT(predicted(cube(6, {22e6, 0.3, 1000})).time_us, easy);  // stiff: the factor at 1 ms
}

TEST(StepTime, Of_what_was_never_measured_says_so) {
    Asset asset = cube(14, {1e9, 0.3, 1000});  // 16,464 tetrahedra
    asset.palette.push_back({1e5, 0.3, 1000});
    asset.palette_index[0] = 1;  // too large for a factor, too hard for a Laplacian
    const StepPrediction step = predicted(asset);
    EXPECT_FALSE(step.calibrated);
    EXPECT_GT(step.high_us, 10 * step.time_us);
}

}  // namespace
}  // namespace knead::tools
