// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "chain/programs.h"

namespace knead::test {
namespace {

std::string build_command(const std::filesystem::path& scene, const std::filesystem::path& folder,
                          const std::string& more) {
    return "knead build " + scene.string() + " -o " + folder.string() + " " + more;
}

TEST(Chain, Baked_twice_with_one_and_two_threads_gives_identical_bytes) {
    const auto folder = fresh_folder();
    const auto scene = std::filesystem::path(KNEAD_EXAMPLES) / "steak/steak.toml";
    ASSERT_EQ(run_program(build_command(scene, folder / "one", "-j 1"), folder / "log"), 0)
        << content_of(folder / "log");
    ASSERT_EQ(run_program(build_command(scene, folder / "two", "-j 2"), folder / "log"), 0)
        << content_of(folder / "log");
    std::size_t compared = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "one")) {
        if (entry.path().extension() != ".hdf") continue;
        EXPECT_EQ(content_of(entry.path()), content_of(folder / "two" / entry.path().filename()))
            << entry.path();
        ++compared;
    }
    EXPECT_EQ(compared, 20u);
}

TEST(Chain, Built_again_keeps_everything_and_after_a_change_makes_only_what_depends_on_it) {
    const auto folder = fresh_folder();
    const auto scene = folder / "cube.toml";
    std::string text = content_of(std::filesystem::path(KNEAD_EXAMPLES) / "cubes/scenario1.toml");
    std::ofstream(scene) << text;
    const std::string command = build_command(scene, folder / "out", "-l k3-1296");
    ASSERT_EQ(run_program(command, folder / "log"), 0) << content_of(folder / "log");
    EXPECT_EQ(occurrences(content_of(folder / "log"), " made "), 8u);
    ASSERT_EQ(run_program(command, folder / "log"), 0);
    EXPECT_EQ(occurrences(content_of(folder / "log"), " made "), 0u);
    EXPECT_EQ(occurrences(content_of(folder / "log"), " kept "), 8u);

    const std::string level = "name = \"k3-1296\"\nbins = 2\nclusters = 3";
    const auto at = text.find(level);
    ASSERT_NE(at, std::string::npos);
    std::ofstream(scene) << text.replace(at, level.size(), level + "\nrule = \"volume-average\"");
    ASSERT_EQ(run_program(command, folder / "log"), 0);
    EXPECT_EQ(occurrences(content_of(folder / "log"), " made "), 2u)
        << content_of(folder / "log");  // coarsen, bake
}

TEST(Chain, Of_the_examples_gives_valid_assets) {
    const auto folder = fresh_folder();
    for (int scenario = 1; scenario <= 9; ++scenario) {
        const std::string name = "scenario" + std::to_string(scenario);
        const auto scene = std::filesystem::path(KNEAD_EXAMPLES) / "cubes" / (name + ".toml");
        ASSERT_EQ(run_program(build_command(scene, folder / name, ""), folder / "log"), 0)
            << content_of(folder / "log");
        for (const char* level : {"reference", "homogenised", "k1-6000", "k3-3072", "k6-1296"})
            EXPECT_EQ(run_program(
                          "knead-asset validate " + (folder / name / (name + "." + level + ".hdf")).string(),
                          folder / "log"),
                      0)
                << name << level << content_of(folder / "log");
    }
}

}  // namespace
}  // namespace knead::test
