// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <limits>

#include "evaluate/cell_json.h"
#include "evaluate/evaluation.h"
#include "evaluate/static_answer.h"
#include "evaluate/tables.h"

namespace knead::tools {
namespace {

class Cache : public testing::Test {
  protected:
    void SetUp() override {
        folder_ =
            std::filesystem::path(testing::TempDir()) /
            ("knead-cache-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::remove_all(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path folder_;
};

TEST_F(Cache, What_is_kept_is_found_by_another_cache_of_the_same_folder) {
    ResultCache(folder_, "program").keep("key", "content");
    EXPECT_EQ(ResultCache(folder_, "program").find("key"), "content");
}

TEST_F(Cache, Another_key_or_another_program_finds_nothing) {
    const ResultCache cache(folder_, "program");
    cache.keep("key", "content");
    EXPECT_EQ(cache.find("other key"), std::nullopt);
    EXPECT_EQ(ResultCache(folder_, "newer program").find("key"), std::nullopt);
}

TEST_F(Cache, Entry_that_was_cut_short_or_changed_is_not_believed) {
    const ResultCache cache(folder_, "program");
    cache.keep("key", "a content of some length");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
        if (!entry.is_regular_file()) continue;
        std::filesystem::resize_file(entry.path(), std::filesystem::file_size(entry.path()) - 1);
    }
    EXPECT_EQ(cache.find("key"), std::nullopt);
}

TEST_F(Cache, Without_a_folder_nothing_is_kept) {
    const ResultCache cache({}, "program");
    cache.keep("key", "content");
    EXPECT_EQ(cache.find("key"), std::nullopt);
}

TEST(CachedAnswer, Bytes_of_an_answer_give_it_back) {
    StaticAnswer answer;
    answer.converged = true;
    answer.force_n = 12.5;
    answer.displacement_m = {{1, 2, 3}, {4, 5, 6}};
    answer.problem = "none";
    const auto back = answer_of(to_bytes(answer));
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->converged);
    EXPECT_EQ(back->force_n, 12.5);
    EXPECT_EQ(back->displacement_m, answer.displacement_m);
    EXPECT_EQ(back->problem, "none");
}

TEST(CachedAnswer, Text_of_other_types_is_no_answer_and_no_error) {
    CellResult cell;
    EXPECT_FALSE(from_cache(R"({"converged":1,"runtime_force_n":null})", cell));
    EXPECT_FALSE(times_from_cache(R"({"load_ms":null,"asset_bytes":1,"step":5})", cell));
    SpeedPair pair;
    EXPECT_FALSE(speed_from_cache(R"({"runtime":null,"baseline":1})", pair));
    ForceCurve curve;
    EXPECT_FALSE(curve_from_cache(R"({"time_s":[0,"one"],"force_n":[1,2]})", curve));
    EXPECT_FALSE(curve_from_cache(R"({"time_s":[0],"force_n":[1,2]})", curve));
    const double no_number = std::numeric_limits<double>::quiet_NaN();
    for (const auto& head : {std::array{1.0, 2.0, no_number, 0.0}, std::array{1.0, 2.0, 3.0, no_number},
                             std::array{1.0, 2.0, 3.0, 1e300}, std::array{1.0, 2.0, 1e300, 0.0}})
        EXPECT_FALSE(answer_of({reinterpret_cast<const char*>(head.data()), sizeof head}).has_value());
}

TEST(CachedAnswer, Counts_that_their_type_cannot_hold_are_no_answer) {
    for (const char* count : {"5e30", "-1", "-1e9", "4294967296", "1.5", "true", "null"}) {
        const std::string step =
            std::string(R"({"p50":1,"p99":2,"p999":3,"max":4,"not_ok":0,"steps":)") + count + "}";
        CellResult cell;
        EXPECT_FALSE(times_from_cache(R"({"load_ms":1,"asset_bytes":1,"step":)" + step + "}", cell)) << count;
        EXPECT_FALSE(cell.load_ms || cell.asset_bytes || cell.step) << "filled in part: " << count;
        SpeedPair pair;
        EXPECT_FALSE(speed_from_cache(R"({"runtime":)" + step + R"(,"baseline":)" + step + "}", pair))
            << count;
    }
}

TEST(CachedAnswer, Speeds_and_curves_from_the_cache_are_those_that_were_kept) {
    const SpeedPair kept{{1, 2, 3, 4, 5, 0}, {6, 7, 8, 9, 10, 1}};
    SpeedPair pair;
    ASSERT_TRUE(speed_from_cache(speed_to_cache(kept), pair));
    EXPECT_EQ(pair.runtime.p999_us, 3);
    EXPECT_EQ(pair.baseline.steps, 10);
    EXPECT_EQ(pair.baseline.not_ok, 1);
    ForceCurve curve;
    ASSERT_TRUE(curve_from_cache(curve_to_cache({{0, 0.001}, {0, -1.5}}), curve));
    EXPECT_EQ(curve.time_s, (std::vector<double>{0, 0.001}));
    EXPECT_EQ(curve.force_n, (std::vector<double>{0, -1.5}));
}

TEST(CachedAnswer, Bytes_that_end_too_early_are_refused) {
    StaticAnswer answer;
    answer.displacement_m = {{1, 2, 3}, {4, 5, 6}};
    const std::string bytes = to_bytes(answer);
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_FALSE(answer_of(bytes.substr(0, length))) << length;
}

CellResult cell(double error, std::uint64_t seed) {
    CellResult result;
    result.load = "press10";
    result.seed = seed;
    result.converged = true;
    result.reference_force_n = 10;
    result.force_n = 10 * (1 + error);
    result.force_error = error;
    return result;
}

TEST(Cells, Error_of_exactly_the_jnd_is_within_and_one_above_is_not) {
    EXPECT_TRUE(cell(0.1, 1).within_jnd());
    EXPECT_TRUE(cell(-0.1, 1).within_jnd());
    EXPECT_FALSE(cell(0.1001, 1).within_jnd());
    EXPECT_FALSE(cell(-0.1001, 1).within_jnd());
}

TEST(Cells, Cell_that_did_not_converge_is_never_within_and_counts_as_above) {
    SceneResult scene;
    scene.cells = {cell(0, 1)};
    scene.cells[0].converged = false;
    EXPECT_FALSE(scene.cells[0].within_jnd());
    EXPECT_EQ(count_above({scene}, 10), 1u);
    EXPECT_TRUE(to_json(scene.cells[0]).at("force_n").is_null());
}

TEST(Cells, Spread_of_three_seeds_is_mean_deviation_lowest_and_highest) {
    SceneResult scene;
    scene.cells = {cell(0.05, 1), cell(0.2, 2), cell(-0.1, 3)};
    const std::vector<Spread> rows = spreads(scene);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_NEAR(rows[0].mean, 0.05, 1e-12);
    EXPECT_NEAR(rows[0].deviation, 0.15, 1e-12);
    EXPECT_EQ(rows[0].lowest, -0.1);
    EXPECT_EQ(rows[0].highest, 0.2);
    EXPECT_EQ(rows[0].within_jnd, 2u);
}

TEST(Cells, Runtime_that_differs_by_more_than_a_thousandth_is_named) {
    SceneResult scene;
    scene.name = "cube";
    scene.cells = {cell(0, 1), cell(0, 2)};
    scene.cells[0].runtime_force_n = 10.009;
    EXPECT_EQ(disagreements({scene}), "");
    scene.cells[1].runtime_force_n = 10.02;
    EXPECT_NE(disagreements({scene}).find("seed 2"), std::string::npos);
}

TEST(Cells, Cell_from_the_cache_is_the_one_that_was_kept) {
    CellResult kept = cell(0.05, 1);
    kept.displacement_error = 0.01;
    kept.runtime_force_n = 10.5;
    kept.tetrahedra = 6;
    CellResult found;
    ASSERT_TRUE(from_cache(to_cache(kept), found));
    EXPECT_EQ(found.force_n, kept.force_n);
    EXPECT_NEAR(found.force_error, kept.force_error, 1e-12);
    EXPECT_EQ(found.runtime_force_n, kept.runtime_force_n);
    EXPECT_FALSE(from_cache("{", found));
    EXPECT_FALSE(from_cache("{}", found));
}

}  // namespace
}  // namespace knead::tools
