// SPDX-License-Identifier: Apache-2.0
// Disks that are full, read-only, shared by two builds, or lose the end of a file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cstdlib>
#include <fstream>

#include "crash/program.h"
#include "crash/work_folder.h"

namespace knead::test {
namespace {

namespace fs = std::filesystem;
using Content = std::map<std::string, std::string>;

constexpr int kCannotWrite = 4;
const std::string kBuild = "knead build scene.toml -o out -q";

Content results_in(const fs::path& folder) {
    Content results = content_of_folder(folder);
    for (auto entry = results.begin(); entry != results.end();)
        entry = fs::path(entry->first).extension() == ".hdf" ? std::next(entry) : results.erase(entry);
    return results;
}

/// What an undisturbed build makes, all of it.
Content wanted_results() {
    const WorkFolder folder("wanted");
    EXPECT_EQ(run(kBuild, folder.path()), 0);
    return results_in(folder / "out");
}

void expect_only_complete(const fs::path& out, const Content& wanted) {
    for (const auto& [name, bytes] : results_in(out)) {
        ASSERT_EQ(wanted.count(name), 1U) << name;
        EXPECT_TRUE(bytes == wanted.at(name)) << name;
    }
}

/// A disk of its own, small, mounted on `place`. Needs the right to mount.
class SmallDisk {
  public:
    SmallDisk(fs::path place, const char* options) : place_(std::move(place)) {
        fs::create_directories(place_);
        mounted_ = mount("tmpfs", place_.c_str(), "tmpfs", 0, options) == 0;
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    ~SmallDisk() {
        if (mounted_) (void)umount(place_.c_str());
    }
    [[nodiscard]] bool mounted() const { return mounted_; }
    [[nodiscard]] bool change(unsigned long flags, const char* options) const {
        return mount("tmpfs", place_.c_str(), "tmpfs", MS_REMOUNT | flags, options) == 0;
    }

  private:
    fs::path place_;
    bool mounted_ = false;
};

TEST(Full_disk, keeps_what_is_complete_and_the_next_build_finishes) {
    const Content wanted = wanted_results();
    for (const char* size : {"size=4k", "size=24k", "size=52k", "size=88k"}) {
        const WorkFolder folder("full");
        const SmallDisk disk(folder / "out", size);
        if (!disk.mounted()) GTEST_SKIP() << "this user may not mount a small disk";
        EXPECT_EQ(run(kBuild, folder.path()), kCannotWrite) << size;
        expect_only_complete(folder / "out", wanted);
        for (const auto& [name, bytes] : content_of_folder(folder / "out"))
            EXPECT_TRUE(wanted.count(name) > 0 || name == ".knead-build.json") << name << " was left behind";
        ASSERT_TRUE(disk.change(0, "size=4m"));
        EXPECT_EQ(run(kBuild, folder.path()), 0) << size;
        EXPECT_TRUE(results_in(folder / "out") == wanted) << size;
    }
}

/// The same for users who may not mount: a limit on the size of files stands for the full disk.
TEST(Limited_file_size, keeps_what_is_complete_and_the_next_build_finishes) {
    const Content wanted = wanted_results();
    for (const char* blocks : {"1", "17", "25"}) {  // of 512 bytes
        const WorkFolder folder("limit");
        const std::string limited =
            std::string("sh -c \"trap '' XFSZ; ulimit -f ") + blocks + "; exec " + kBuild + "\"";
        EXPECT_EQ(run(limited, folder.path()), kCannotWrite) << blocks;
        expect_only_complete(folder / "out", wanted);
        EXPECT_EQ(run(kBuild, folder.path()), 0) << blocks;
        EXPECT_TRUE(results_in(folder / "out") == wanted) << blocks;
    }
}

TEST(Read_only_output, changes_nothing_and_is_told) {
    const Content wanted = wanted_results();
    const WorkFolder folder("readonly");
    const SmallDisk disk(folder / "out", "size=4m");
    if (!disk.mounted()) GTEST_SKIP() << "this user may not mount a small disk";
    ASSERT_EQ(run(kBuild, folder.path()), 0);
    ASSERT_TRUE(disk.change(MS_RDONLY, "size=4m"));
    const Content before = content_of_folder(folder / "out");
    EXPECT_EQ(run(kBuild, folder.path()), 0) << "nothing is to be made";
    EXPECT_EQ(run(kBuild + " --force", folder.path()), kCannotWrite);
    EXPECT_EQ(run("knead-overlap fine.hdf coarse.hdf -q -o out/golden.k3.overlap.hdf", folder.path()),
              kCannotWrite);
    EXPECT_TRUE(content_of_folder(folder / "out") == before);
}

TEST(Two_builds_into_one_folder, both_finish_with_the_same_files) {
    const Content wanted = wanted_results();
    for (int round = 0; round < 3; ++round) {
        const WorkFolder folder("two");
        Program first(kBuild, folder.path());
        wait_us(20'000.0 * round);
        Program second(kBuild, folder.path());
        EXPECT_EQ(first.wait(), 0) << round;
        EXPECT_EQ(second.wait(), 0) << round;
        EXPECT_TRUE(results_in(folder / "out") == wanted) << round;
        EXPECT_EQ(run(kBuild, folder.path()), 0);
        for (const auto& [name, bytes] : content_of_folder(folder / "out"))
            EXPECT_TRUE(wanted.count(name) > 0 || name == ".knead-build.json") << name << " was left behind";
    }
}

/// A power cut before a temporary file was flushed leaves the beginning of it beside the old output.
TEST(Power_cut_while_writing, leaves_a_leftover_that_disturbs_nobody) {
    const Content wanted = wanted_results();
    const WorkFolder folder("leftover");
    ASSERT_EQ(run(kBuild, folder.path()), 0);
    for (const auto& [name, bytes] : wanted)
        for (const double share : {0.0, 0.3, 0.99})
            std::ofstream(folder / ("out/." + name + ".1." + std::to_string(int(100 * share)) + ".tmp"),
                          std::ios::binary)
                << bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
    EXPECT_EQ(run(kBuild, folder.path()), 0);
    EXPECT_EQ(run(kBuild + " --force", folder.path()), 0);
    EXPECT_TRUE(results_in(folder / "out") == wanted);
}

/// A disk that forgets the end of a file although it said that it was flushed: the next build sees it.
TEST(Truncated_output, is_refused_and_made_again) {
    const Content wanted = wanted_results();
    const WorkFolder folder("truncated");
    ASSERT_EQ(run(kBuild, folder.path()), 0);
    for (const auto& [name, bytes] : wanted) {
        const fs::path file = folder / ("out/" + name);
        for (const std::size_t left : {std::size_t{0}, bytes.size() / 3, bytes.size() - 1}) {
            fs::resize_file(file, left);
            EXPECT_EQ(run("knead-asset validate out/" + name, folder.path()), 1) << name << " " << left;
        }
        EXPECT_EQ(run(kBuild, folder.path()), 0) << name;
        EXPECT_TRUE(results_in(folder / "out") == wanted) << name;
    }
    fs::resize_file(folder / "out/.knead-build.json", 100);
    EXPECT_EQ(run(kBuild, folder.path()), 0) << "a broken memory costs a rebuild and nothing else";
    EXPECT_TRUE(results_in(folder / "out") == wanted);
}

}  // namespace
}  // namespace knead::test
