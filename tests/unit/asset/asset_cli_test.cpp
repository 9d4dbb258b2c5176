// SPDX-License-Identifier: Apache-2.0
// Runs the program knead-asset: exit codes, streams and files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "unit/formats/samples.h"

namespace knead::test {
namespace {

using ::testing::HasSubstr;

class Asset_program : public ::testing::Test {
  protected:
    struct Outcome {
        int code = -1;
        std::string out, err;
    };

    Outcome run(const std::string& arguments) const {
        const auto out = folder_ / "out.txt", err = folder_ / "err.txt";
        const std::string command = "cd '" + folder_.path().string() + "' && '" KNEAD_BIN "/knead-asset' " +
                                    arguments + " >'" + out.string() + "' 2>'" + err.string() + "'";
        const int status = std::system(command.c_str());
        const std::vector<char> o = bytes_of(out), e = bytes_of(err);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, {o.begin(), o.end()}, {e.begin(), e.end()}};
    }

    void SetUp() override {
        ASSERT_TRUE(write_asset(folder_ / "asset.hdf", sample_asset(), sample_provenance()).ok());
        ASSERT_TRUE(write_material(folder_ / "material.hdf", sample_material(), {}).ok());
        ASSERT_TRUE(write_overlap(folder_ / "overlap.hdf", sample_overlap(), {}).ok());
        put_bytes(folder_ / "text.hdf", {'x'});
    }

    Folder folder_;
};

TEST_F(Asset_program, Info_prints_the_groups) {
    for (const char* file : {"asset.hdf", "material.hdf", "overlap.hdf"}) {
        EXPECT_EQ(run(std::string("info ") + file).code, 0) << file;
        EXPECT_THAT(run(std::string("info --json ") + file).out, HasSubstr("\"content_hash\"")) << file;
    }
    EXPECT_THAT(run("info asset.hdf").out, HasSubstr("asked for by tool[0] (line 12)"));
    EXPECT_EQ(run("info text.hdf").code, 3);
}

TEST_F(Asset_program, Validate_answers_with_0_or_1_and_names_the_code) {
    EXPECT_EQ(run("validate asset.hdf").code, 0);
    const Outcome outcome = run("validate text.hdf");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.out, "text.hdf: not_knead: is not an HDF5 file\n");
    EXPECT_EQ(run("validate none.hdf").code, 3);
}

TEST_F(Asset_program, Diff_answers_with_0_or_1) {
    Asset moved = sample_asset();
    moved.damping_per_s += 0.5;
    ASSERT_TRUE(write_asset(folder_ / "moved.hdf", moved, {}).ok());
    EXPECT_EQ(run("diff asset.hdf asset.hdf").code, 0);
    const Outcome outcome = run("diff asset.hdf moved.hdf");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.out,
                HasSubstr("/knead/asset/damping/mass_proportional_per_s: 1 of 1 values differ, first at "
                          "[0]: 2.5 and 3; largest difference 0.5"));
    EXPECT_EQ(run("diff asset.hdf moved.hdf --abs mass_proportional_per_s=0.6").code, 0);
    EXPECT_EQ(run("diff asset.hdf moved.hdf --rel 0.3 -q").code, 0);
    EXPECT_EQ(run("diff --rel 0.1 asset.hdf moved.hdf").code, 1);
    EXPECT_EQ(run("diff --rel x asset.hdf moved.hdf").code, 2);
    EXPECT_EQ(run("diff --abs nothing=1 asset.hdf moved.hdf").code, 2);
    EXPECT_EQ(run("diff asset.hdf material.hdf").code, 1);
    EXPECT_EQ(run("diff asset.hdf text.hdf").code, 3);
}

TEST_F(Asset_program, Export_writes_both_formats) {
    EXPECT_EQ(run("export asset.hdf -o a.vtu").code, 0);
    EXPECT_EQ(run("export material.hdf --output m.msh").code, 0);
    EXPECT_EQ(bytes_of(folder_ / "m.msh").at(0), '$');
    EXPECT_EQ(run("export overlap.hdf -o o.vtu").code, 3);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "o.vtu"));
    EXPECT_EQ(run("export asset.hdf -o a.stl").code, 2);
    EXPECT_EQ(run("export asset.hdf -o none/a.vtu").code, 4);
    EXPECT_EQ(run("export asset.hdf").code, 2);
}

TEST_F(Asset_program, Says_how_it_is_used) {
    EXPECT_EQ(run("--help").code, 0);
    EXPECT_EQ(run("info --help").code, 0);
    EXPECT_THAT(run("--version").out, HasSubstr("file format 1.2"));
    EXPECT_EQ(run("").code, 2);
    EXPECT_EQ(run("info").code, 2);
    EXPECT_EQ(run("melt asset.hdf").code, 2);
}

}  // namespace
}  // namespace knead::test
