// SPDX-License-Identifier: Apache-2.0
#include "knead/child_process.h"

#include <gtest/gtest.h>

#include "common/error.h"

namespace knead::tools {
namespace {

int run_shell(const std::string& script, std::string& errors) {
    return run_child("/bin/sh", {"-c", script}, [&](std::string_view text) { errors += text; });
}

TEST(ChildProcess, Yields_exit_code_and_standard_error) {
    std::string errors;
    EXPECT_EQ(run_shell("echo dropped; echo told >&2; exit 5", errors), 5);
    EXPECT_EQ(errors, "told\n");
}

TEST(ChildProcess, Ended_by_a_signal_yields_128_and_more) {
    std::string errors;
    EXPECT_EQ(run_shell("kill -9 $$", errors), 128 + 9);
}

TEST(ChildProcess, With_a_lot_to_say_does_not_hang) {
    std::string errors;
    EXPECT_EQ(run_shell("i=0; while [ $i -lt 20000 ]; do echo 0123456789 >&2; i=$((i+1)); done", errors), 0);
    EXPECT_EQ(errors.size(), 20000u * 11u);
}

TEST(ChildProcess, That_does_not_exist_is_refused) {
    EXPECT_THROW((void)run_child("/nonexistent/tool", {}, [](std::string_view) {}), ToolError);
    EXPECT_THROW((void)find_tool("knead-no-such-tool"), ToolError);
}

}  // namespace
}  // namespace knead::tools
