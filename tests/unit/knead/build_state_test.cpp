// SPDX-License-Identifier: Apache-2.0
#include "knead/build_state.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/error.h"

namespace knead::tools {
namespace {

void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file) << text;
}

class State : public testing::Test {
  protected:
    void SetUp() override {
        folder_ =
            std::filesystem::path(testing::TempDir()) /
            ("build_state_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directory(folder_);
        program_ = folder_ / "tool";
        write(program_, "version 1");
        write(folder_ / "in.csv", "1");
        write(folder_ / "out.txt", "result");
        stage_ = {"tool", {"--k", "3"}, folder_ / "out.txt", false};
        BuildState state = BuildState::load(folder_);
        EXPECT_FALSE(state.up_to_date(stage_, program_));
        state.record(stage_, program_, {folder_ / "in.csv"});
        state.save();
    }

    bool up_to_date() { return BuildState::load(folder_).up_to_date(stage_, program_); }

    std::filesystem::path folder_;
    std::filesystem::path program_;
    Stage stage_;
};

TEST_F(State, Recorded_is_up_to_date_after_loading) {
    EXPECT_TRUE(up_to_date());
}

TEST_F(State, Is_stale_after_another_argument) {
    stage_.arguments[1] = "4";
    EXPECT_FALSE(up_to_date());
}

TEST_F(State, Is_stale_after_another_input) {
    write(folder_ / "in.csv", "2");
    EXPECT_FALSE(up_to_date());
}

TEST_F(State, Is_stale_without_its_input) {
    std::filesystem::remove(folder_ / "in.csv");
    EXPECT_FALSE(up_to_date());
}

TEST_F(State, Is_stale_after_a_change_of_the_output) {
    write(folder_ / "out.txt", "edited by hand");
    EXPECT_FALSE(up_to_date());
}

TEST_F(State, Is_stale_after_a_new_version_of_the_tool) {
    write(program_, "version 2");
    EXPECT_FALSE(up_to_date());
}

TEST_F(State, Does_not_look_at_file_times) {
    std::filesystem::last_write_time(folder_ / "in.csv", std::filesystem::file_time_type::clock::now());
    EXPECT_TRUE(up_to_date());
}

TEST_F(State, That_is_damaged_counts_as_empty) {
    write(folder_ / ".knead-build.json", "{\"schema\": \"knead-build/1\", \"stages\": {\"out.txt\": 3}}");
    EXPECT_FALSE(up_to_date());
    write(folder_ / ".knead-build.json", "{{{");
    EXPECT_FALSE(up_to_date());
    write(folder_ / ".knead-build.json", "{\"schema\": 5}");
    EXPECT_FALSE(up_to_date());
}

TEST_F(State, Reads_depfiles_with_escaped_blanks) {
    write(folder_ / "a.d", "out.hdf: \\\n  my\\ mesh.hdf \\\n  a$$b.csv\n");
    EXPECT_EQ(read_depfile(folder_ / "a.d"), (std::vector<std::filesystem::path>{"my mesh.hdf", "a$b.csv"}));
    EXPECT_THROW((void)read_depfile(folder_ / "in.csv"), ToolError);
}

}  // namespace
}  // namespace knead::tools
