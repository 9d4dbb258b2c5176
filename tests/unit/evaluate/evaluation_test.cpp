// SPDX-License-Identifier: Apache-2.0
#include "evaluate/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/error.h"
#include "evaluate/prepared_scene.h"

namespace knead::tools {
namespace {

/// A small cube of scenario 1 with a coarser level, in a folder of its own.
class SmallScene : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  ("knead-evaluation-" +
                   std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
        scene_ = folder_ / "cube.toml";
        std::ofstream(scene_) << R"(
name = "cube"
[mesh]
kind = "cubes"
size = "10cm"
divisions = 4
[material]
scenario = 1
[[level]]
name = "fine-level"
[[level]]
name = "coarse"
mesh = { divisions = 3 }
[[held]]
side = "bottom"
[[tool]]
name = "press"
shape = "plate"
contact = "bonded"
touches = { side = "top" }
)";
        request_.scenes = {scene_};
        request_.methods = {
            {MethodKind::homogenised, 1, 1}, {MethodKind::paper, 2, 2}, {MethodKind::voigt, 0, 0}};
        request_.loads = {"press10", "pad4", "scene"};
        request_.seeds = 2;
        request_.timed_steps = 0;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::vector<SceneResult> run(const std::filesystem::path& cache = {}) {
        computed_ = 0;
        EvaluationListener listener;
        listener.progress = [this](std::size_t, std::size_t, std::string_view) { ++computed_; };
        return evaluate(request_, ResultCache(cache, "test"), read_, listener);
    }

    std::filesystem::path folder_, scene_;
    EvaluationRequest request_;
    FileReader read_ = [](const std::filesystem::path&) { return std::string(); };
    int computed_ = 0;
};

bool same(const std::vector<SceneResult>& a, const std::vector<SceneResult>& b) {
    if (a.size() != b.size() || a[0].cells.size() != b[0].cells.size()) return false;
    for (std::size_t k = 0; k < a[0].cells.size(); ++k)
        if (a[0].cells[k].force_n != b[0].cells[k].force_n ||
            a[0].cells[k].displacement_error != b[0].cells[k].displacement_error)
            return false;
    return true;
}

TEST_F(SmallScene, Every_method_load_and_seed_has_a_cell_that_converged) {
    const std::vector<SceneResult> results = run();
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].reference_tetrahedra, 384u);
    EXPECT_EQ(results[0].cells.size(), 3u * 3u * 2u);
    for (const CellResult& cell : results[0].cells) {
        EXPECT_TRUE(cell.converged) << cell.problem;
        EXPECT_EQ(cell.tetrahedra, 162u);
        EXPECT_GT(cell.force_n, 0);
        EXPECT_NEAR(cell.force_error, cell.force_n / cell.reference_force_n - 1, 1e-12);
    }
}

TEST_F(SmallScene, Runtime_is_asked_for_the_press_and_the_scenes_tool_and_agrees_with_the_solver) {
    const std::vector<SceneResult> results = run();
    for (const CellResult& cell : results[0].cells) {
        EXPECT_EQ(cell.runtime_force_n.has_value(), cell.load != "pad4") << cell.load;
        EXPECT_LE(cell.runtime_disagreement(), kRuntimeAgreement) << cell.load;
    }
}

TEST_F(SmallScene, Raw_elasticities_on_the_fine_mesh_are_the_reference) {
    request_.methods = {{MethodKind::raw_dominant, 0, 0}};
    request_.levels = {"fine"};
    const std::vector<SceneResult> results = run();
    for (const CellResult& cell : results[0].cells) {
        EXPECT_EQ(cell.force_error, 0) << cell.load;
        EXPECT_NEAR(cell.displacement_error, 0, 1e-12)
            << cell.load;  // places are weights of rounding precision
    }
}

TEST_F(SmallScene, Finer_reference_has_eight_times_the_tetrahedra_and_is_softer) {
    request_.methods = {{MethodKind::raw_dominant, 0, 0}};
    request_.levels = {"fine"};
    request_.reference = ReferenceKind::finer;
    const std::vector<SceneResult> results = run();
    EXPECT_EQ(results[0].reference_tetrahedra, 8u * 384u);
    for (const CellResult& cell : results[0].cells)
        EXPECT_GT(cell.force_error, 0.01) << cell.load;  // more displacements allowed: less energy
}

TEST_F(SmallScene, Results_do_not_depend_on_the_number_of_threads) {
    const std::vector<SceneResult> one = run();
    request_.threads = 3;
    EXPECT_TRUE(same(one, run()));
}

TEST_F(SmallScene, Run_that_was_interrupted_finds_what_was_done_and_gives_the_same) {
    const std::vector<SceneResult> whole = run();
    const std::filesystem::path cache = folder_ / "cache";
    EvaluationListener listener;
    int done = 0;
    listener.progress = [&](std::size_t, std::size_t, std::string_view) {
        if (++done == 6) throw std::runtime_error("interrupted");
    };
    EXPECT_THROW((void)evaluate(request_, ResultCache(cache, "test"), read_, listener), std::runtime_error);
    std::size_t kept = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(cache))
        kept += entry.is_regular_file() ? 1 : 0;
    EXPECT_GE(kept, 5u);
    EXPECT_TRUE(same(whole, run(cache)));
    // Everything is known now: a folder that cannot be written to does not matter.
    EXPECT_TRUE(same(whole, run(cache)));
}

TEST_F(SmallScene, Cache_of_a_changed_scene_is_not_believed) {
    const std::filesystem::path cache = folder_ / "cache";
    const std::vector<SceneResult> before = run(cache);
    std::ifstream in(scene_);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text.replace(text.find("scenario = 1"), 12, "scenario = 2");
    std::ofstream(scene_) << text;
    EXPECT_FALSE(same(before, run(cache)));
}

TEST_F(SmallScene, Kmod09_is_solved_but_not_asked_of_the_runtime) {
    request_.methods = {
        {MethodKind::kmod09, 0, 0}, {MethodKind::iycn13, 0, 0}, {MethodKind::calibrated, 0, 0}};
    request_.seeds = 1;
    request_.timed_steps = 10;
    const std::vector<SceneResult> results = run();
    for (const CellResult& cell : results[0].cells) {
        EXPECT_TRUE(cell.converged) << cell.method.text() << ": " << cell.problem;
        EXPECT_LT(std::abs(cell.force_error), 0.5) << cell.method.text();
        const bool in_runtime = cell.method.kind != MethodKind::kmod09;
        EXPECT_EQ(cell.step.has_value(), in_runtime) << cell.method.text();
        EXPECT_EQ(cell.asset_bytes.has_value(), in_runtime);
        EXPECT_EQ(cell.fitted, cell.method.kind == MethodKind::calibrated && cell.load != "pad4");
    }
}

TEST_F(SmallScene, Method_that_does_not_apply_is_left_out_with_a_note) {
    std::ifstream in(scene_);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text.replace(text.find("contact = \"bonded\""), 18, "contact = \"sticking\"");
    std::ofstream(scene_) << text;
    request_.methods = {{MethodKind::kmod09, 0, 0}};
    request_.loads = {"press10", "scene"};
    request_.seeds = 1;
    const std::vector<SceneResult> results = run();
    ASSERT_EQ(results[0].cells.size(), 1u);
    EXPECT_EQ(results[0].cells[0].load, "press10");
    ASSERT_EQ(results[0].notes.size(), 1u);
    EXPECT_NE(results[0].notes[0].find("kmod09"), std::string::npos);
}

TEST_F(SmallScene, Zero_seeds_are_bad_usage) {
    request_.seeds = 0;
    EXPECT_THROW((void)run(), ToolError);
}

TEST_F(SmallScene, Unknown_level_names_the_nearest) {
    request_.levels = {"coarze"};
    try {
        (void)run();
        FAIL();
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_usage);
        EXPECT_NE(std::string(error.what()).find("did you mean coarse"), std::string::npos) << error.what();
    }
}

TEST_F(SmallScene, Level_by_its_number_of_tetrahedra_is_the_cube_with_so_many) {
    request_.levels = {"162"};
    request_.seeds = 1;
    EXPECT_EQ(run()[0].cells.front().tetrahedra, 162u);
    request_.levels = {"170"};
    EXPECT_THROW((void)run(), ToolError);
}

}  // namespace
}  // namespace knead::tools
