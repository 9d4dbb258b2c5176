// SPDX-License-Identifier: Apache-2.0
// kill -9 at random moments: afterwards the output is the old file or the new one, complete, and the next run
// makes the new one. KNEAD_CRASH_KILLS sets how many kills in all (20 otherwise), KNEAD_CRASH_SEED the
// moments.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <regex>

#include "crash/program.h"
#include "crash/work_folder.h"

namespace knead::test {
namespace {

namespace fs = std::filesystem;
using Content = std::map<std::string, std::string>;

struct Tool {
    const char* name;
    const char* command;  ///< writes out.hdf from the golden files
    const char* older;    ///< writes another out.hdf
};

/// How gtest prints the parameter: CTest puts it into the test's line.
void PrintTo(const Tool& tool, std::ostream* stream) {
    *stream << tool.name;
}

constexpr Tool kTools[] = {
    {"mesh", "knead-mesh cubes --divisions 14 --size 10cm -q -o out.hdf",
     "knead-mesh cubes --divisions 2 --size 10cm -q -o out.hdf"},
    {"material", "knead-material fine.hdf --scenario 4 --seed 1 -q -o out.hdf",
     "knead-material fine.hdf --uniform 1000 -q -o out.hdf"},
    {"cluster", "knead-cluster material.hdf --bins 2 --clusters 3 -q -o out.hdf",
     "knead-cluster material.hdf --bins 1 --clusters 1 -q -o out.hdf"},
    {"aggregate", "knead-aggregate clusters.hdf -q -o out.hdf",
     "knead-aggregate clusters.hdf --order soft-first -q -o out.hdf"},
    {"overlap", "knead-overlap fine.hdf coarse.hdf -q -o out.hdf",
     "knead-overlap coarse.hdf coarse.hdf -q -o out.hdf"},
    {"coarsen", "knead-coarsen aggregated.hdf coarse.hdf overlap.hdf -q -o out.hdf",
     "knead-coarsen aggregated.hdf coarse.hdf overlap.hdf --rule volume-average -q -o out.hdf"},
    {"bake", "knead-bake scene.toml coarsened.hdf --level k3 -q -o out.hdf", "cp asset.hdf out.hdf"},
    {"touch", "knead-touch asset.hdf --virtual-time --press 2mm -q --log out.hdf",
     "knead-touch asset.hdf --virtual-time --press 1mm -q --log out.hdf"},
};

/// Portable draws, whatever the library's distributions do.
class Moments {
  public:
    Moments() : random_(seed()) {}
    double share() { return static_cast<double>(random_() >> 11U) * 0x1.0p-53; }

  private:
    static std::uint64_t seed() {
        const char* text = std::getenv("KNEAD_CRASH_SEED");
        return text == nullptr ? 20'261'122 : std::stoull(text);
    }
    std::mt19937_64 random_;
};

int kills_in_all() {
    const char* text = std::getenv("KNEAD_CRASH_KILLS");
    return text == nullptr ? 20 : std::stoi(text);
}

std::string content_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// What may lie about after a kill: names that no tool and no build takes for a result.
bool is_leftover(const std::string& name) {
    static const std::regex kLeftover(R"((.*/)?\..+\.\d+(\.\d+\.tmp|\.d))");
    return std::regex_match(name, kLeftover);
}

/// Kills once; the first half of the kills at any time of the run, the second half just when it writes.
void kill_once(const std::string& command, const fs::path& folder, bool while_writing, double run_us,
               Moments& moments, bool children = true) {
    const Creation creation(folder);
    Program program(command, folder);
    if (while_writing) {
        (void)creation.wait(".tmp", 20);
        wait_us(2000 * moments.share());
    } else {
        wait_us(1.1 * run_us * moments.share());
    }
    program.kill(children);
    (void)program.wait();
}

double duration_us(const std::string& command, const fs::path& folder) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(run(command, folder), 0) << command;
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

class Killed_tool : public testing::TestWithParam<Tool> {};

TEST_P(Killed_tool, leaves_the_old_or_the_new_file_complete) {
    const Tool& tool = GetParam();
    const WorkFolder folder(tool.name);
    const Content inputs = content_of_folder(folder.path());
    const double run_us = duration_us(tool.command, folder.path());
    const std::string fresh = content_of(folder / "out.hdf");
    ASSERT_EQ(run(tool.older, folder.path()), 0);
    const std::string older = content_of(folder / "out.hdf");
    ASSERT_NE(fresh, older);
    Moments moments;
    // Two tenths of all kills are for knead build.
    const int kills = std::max(2, kills_in_all() * 8 / 10 / static_cast<int>(std::size(kTools)));
    for (int i = 0; i < kills; ++i) {
        fs::remove(folder / "out.hdf");
        if (i % 4 < 3) std::ofstream(folder / "out.hdf", std::ios::binary) << older;
        kill_once(tool.command, folder.path(), i % 2 == 1, run_us, moments);
        for (const auto& [name, bytes] : content_of_folder(folder.path())) {
            const bool is_old = i % 4 < 3 && bytes == older;
            const bool good = name == "out.hdf"        ? bytes == fresh || is_old
                              : inputs.count(name) > 0 ? bytes == inputs.at(name)
                                                       : is_leftover(name);
            EXPECT_TRUE(good) << name << " after kill " << i;
        }
        ASSERT_EQ(run(tool.command, folder.path()), 0);
        EXPECT_TRUE(content_of(folder / "out.hdf") == fresh) << "after kill " << i;
    }
    RecordProperty("kills", kills);
    std::printf("%d kills\n", kills);
}

INSTANTIATE_TEST_SUITE_P(of, Killed_tool, testing::ValuesIn(kTools),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

/// The files of a finished build that are results.
Content results_in(const fs::path& folder) {
    Content results;
    for (const auto& [name, bytes] : content_of_folder(folder))
        if (name.size() > 4 && name.substr(name.size() - 4) == ".hdf") results[name] = bytes;
    return results;
}

TEST(Killed_build, leaves_complete_files_and_the_next_build_finishes) {
    const WorkFolder folder("build");
    const std::string build = "knead build scene.toml -o out -q";
    const double run_us = duration_us(build, folder.path());
    const Content wanted = results_in(folder / "out");
    ASSERT_GT(wanted.size(), 5U);
    Moments moments;
    const int kills = std::max(2, kills_in_all() * 2 / 10);
    for (int i = 0; i < kills; ++i) {
        if (i % 3 == 0) fs::remove_all(folder / "out");
        fs::create_directories(folder / "out");
        // Every other time its children go on without it, as they do when only the driver is killed.
        kill_once(build + (i % 3 == 0 ? "" : " --force"), folder.path(), false, run_us, moments, i % 2 == 0);
        for (const auto& [name, bytes] : content_of_folder(folder / "out")) {
            const bool good = wanted.count(name) > 0 ? bytes == wanted.at(name)
                                                     : name == ".knead-build.json" || is_leftover(name);
            EXPECT_TRUE(good) << name << " after kill " << i;
        }
        ASSERT_EQ(run(build, folder.path()), 0);
        EXPECT_TRUE(results_in(folder / "out") == wanted) << "after kill " << i;
    }
    std::printf("%d kills\n", kills);
}

}  // namespace
}  // namespace knead::test
