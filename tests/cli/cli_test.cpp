// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "cli/cli_case.h"
#include "cli/sandbox.h"

namespace knead::test {

/// How gtest prints the parameter. CMake reads it too: a command with its quotes and semicolons would not do.
void PrintTo(const CliCase& cli_case, std::ostream* stream) {
    *stream << cli_case.name;
}

namespace {

using Content = std::map<std::string, std::string>;

/// Files that were made, changed or removed between two looks at the folder.
void expect_changes(const Content& before, const Content& after, const std::set<std::string>& creates) {
    for (const auto& [file, content] : after) {
        const auto old = before.find(file);
        if (old == before.end()) {
            EXPECT_TRUE(creates.count(file) > 0) << file << " was left behind";
        } else {
            EXPECT_TRUE(old->second == content) << file << " was changed";
        }
    }
    for (const auto& [file, content] : before)
        EXPECT_TRUE(after.count(file) > 0) << file << " was removed";
    for (const std::string& file : creates) {
        const auto made = after.find(file);
        ASSERT_NE(made, after.end()) << file << " is missing";
        EXPECT_FALSE(made->second.empty()) << file << " is empty";
    }
}

void expect_patterns(const std::string& text, const std::vector<std::string>& patterns, const char* stream) {
    for (const std::string& pattern : patterns)
        EXPECT_TRUE(std::regex_search(text, std::regex(pattern))) << "no /" << pattern << "/ on " << stream;
}

void expect_failure_manners(const Outcome& outcome) {
    static const std::regex kError("(^|\n)knead[a-z-]*: error: [^\n]+\n$");
    EXPECT_TRUE(std::regex_search(outcome.err, kError)) << "the last line must be \"program: error: ...\"";
    EXPECT_TRUE(outcome.out.empty()) << "a failure prints nothing on standard output";
}

class Cli : public testing::TestWithParam<CliCase> {};

TEST_P(Cli, of) {
    const CliCase& cli_case = GetParam();
    const Sandbox sandbox(cli_case.name);
    for (const auto& [file, content] : cli_case.files)
        sandbox.write(file, content);
    for (const std::string& command : cli_case.setup) {
        const Outcome outcome = sandbox.run(command);
        ASSERT_EQ(outcome.exit_code, 0) << "setup: " << command << "\n" << outcome.err;
    }
    const Content before = sandbox.content();
    const Outcome outcome = sandbox.run(cli_case.command);
    SCOPED_TRACE("command: " + cli_case.command + "\nstdout: " + outcome.out + "\nstderr: " + outcome.err);
    EXPECT_EQ(outcome.exit_code, cli_case.exit_code);
    expect_patterns(outcome.err, cli_case.stderr_patterns, "stderr");
    expect_patterns(outcome.out, cli_case.stdout_patterns, "stdout");
    if (cli_case.exit_code >= 2) expect_failure_manners(outcome);
    expect_changes(before, sandbox.content(), cli_case.creates);
    EXPECT_FALSE(sandbox.has_temporary_files()) << "something was left in TMPDIR";
}

INSTANTIATE_TEST_SUITE_P(all, Cli, testing::ValuesIn(read_cases(KNEAD_CLI_CASES)),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace knead::test
