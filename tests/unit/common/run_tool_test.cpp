// SPDX-License-Identifier: Apache-2.0
#include "common/run_tool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <new>
#include <sstream>

namespace knead::tools {
namespace {

using testing::HasSubstr;

struct Run {
    int exit_code;
    std::string errors;
};

Run run(std::vector<std::string> arguments, const std::function<ExitCode(ToolContext&)>& body) {
    ToolInfo info;
    info.name = "knead-test";
    info.purpose = "a tool of the tests.";
    info.example = "knead-test";
    arguments.insert(arguments.begin(), "knead-test");
    std::vector<char*> argv;
    for (std::string& argument : arguments)
        argv.push_back(argument.data());
    testing::internal::CaptureStderr();
    const int code = run_tool(
        static_cast<int>(argv.size()), argv.data(), info, [](CLI::App&) {}, body);
    return {code, testing::internal::GetCapturedStderr()};
}

TEST(RunTool, Turns_every_outcome_into_its_exit_code) {
    EXPECT_EQ(run({}, [](ToolContext&) { return ExitCode::done; }).exit_code, 0);
    EXPECT_EQ(run({}, [](ToolContext&) { return ExitCode::answer_is_no; }).exit_code, 1);
    EXPECT_EQ(run({"--no-such-option"}, [](ToolContext&) { return ExitCode::done; }).exit_code, 2);
    EXPECT_EQ(run({}, [](ToolContext&) -> ExitCode { fail_input("x"); }).exit_code, 3);
    EXPECT_EQ(run({}, [](ToolContext&) -> ExitCode { fail_result("x"); }).exit_code, 5);
    EXPECT_EQ(run({}, [](ToolContext&) -> ExitCode { throw std::bad_alloc(); }).exit_code, 5);
    EXPECT_EQ(run({}, [](ToolContext&) -> ExitCode { throw std::logic_error("x"); }).exit_code, 70);
    EXPECT_EQ(run({}, [](ToolContext&) -> ExitCode { throw 7; }).exit_code, 70);
}

TEST(RunTool, Turns_an_error_of_the_libraries_into_the_exit_code_that_fits) {
    const auto exit_of = [](ErrorCode error) {
        return run({}, [&](ToolContext&) -> ExitCode {
                   (void)value_or_throw(Result<Unit>(Error{error, "what", "where"}));
                   return ExitCode::done;
               })
            .exit_code;
    };
    EXPECT_EQ(exit_of(ErrorCode::io_error), 3);
    EXPECT_EQ(exit_of(ErrorCode::corrupt), 3);
    EXPECT_EQ(exit_of(ErrorCode::cannot_write), 4);
    EXPECT_EQ(exit_of(ErrorCode::out_of_memory), 5);
}

TEST(RunTool, Names_the_tool_before_an_error) {
    EXPECT_EQ(run({}, [](ToolContext&) -> ExitCode { fail_input("f.hdf: bad"); }).errors,
              "knead-test: error: f.hdf: bad\n");
}

TEST(RunTool, Writes_the_depfile_only_after_success_and_escapes_blanks) {
    const auto depfile = std::filesystem::path(testing::TempDir()) / "run_tool_test.d";
    std::filesystem::remove(depfile);
    const auto body = [](ExitCode code) {
        return [code](ToolContext& context) {
            context.set_output("out.hdf");
            context.add_input("my mesh.hdf");
            return code;
        };
    };
    EXPECT_EQ(run({"--depfile", depfile.string()}, body(ExitCode::answer_is_no)).exit_code, 1);
    EXPECT_FALSE(std::filesystem::exists(depfile));
    EXPECT_EQ(run({"--depfile", depfile.string()}, body(ExitCode::done)).exit_code, 0);
    std::ifstream stream(depfile);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(text, "out.hdf: \\\n  my\\ mesh.hdf\n");
}

TEST(RunTool, Quiet_and_verbose_exclude_each_other) {
    EXPECT_EQ(run({"-q", "-v"}, [](ToolContext&) { return ExitCode::done; }).exit_code, 2);
}

TEST(Length, With_and_without_unit_is_metres) {
    EXPECT_DOUBLE_EQ(parse_length_m("0.004"), 0.004);
    EXPECT_DOUBLE_EQ(parse_length_m("4mm"), 0.004);
    EXPECT_DOUBLE_EQ(parse_length_m("1.5 cm"), 0.015);
    EXPECT_DOUBLE_EQ(parse_length_m("1in"), 0.0254);
}

TEST(Length, That_is_none_is_refused) {
    for (const char* text : {"", "mm", "4 parsec", "nan", "inf", "1e999", "4mm2"})
        EXPECT_THROW((void)parse_length_m(text), ToolError) << text;
}

TEST(OutputFolder, That_does_not_exist_cannot_be_written) {
    try {
        require_writable_folder("/nonexistent/out.hdf");
        FAIL() << "accepted";
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::cannot_write);
        EXPECT_THAT(error.what(), HasSubstr("/nonexistent"));
    }
}

}  // namespace
}  // namespace knead::tools
