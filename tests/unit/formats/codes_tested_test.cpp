// SPDX-License-Identifier: Apache-2.0
// Every error code and every exit code is expected by a test. Reads the tests as text: a code that nobody
// expects, or a new one without a test, is found here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace knead::test {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::set<std::string> words(const std::string& text, const std::string& pattern) {
    std::set<std::string> found;
    const std::regex regex(pattern);
    for (std::sregex_iterator i(text.begin(), text.end(), regex), end; i != end; ++i)
        found.insert((*i)[1]);
    return found;
}

/// The text of all files below `folder` whose name ends in `extension`.
std::string texts_below(const fs::path& folder, const std::string& extension) {
    std::string text;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() == extension &&
            entry.path().filename() != fs::path(__FILE__).filename())
            text += text_of(entry.path());
    return text;
}

/// In an expectation or a helper that makes one, not merely named.
std::set<std::string> codes_in_expectations(const std::string& text) {
    static const std::regex kExpects("EXPECT|ASSERT|expect");
    std::set<std::string> codes;
    std::istringstream statements(text);
    for (std::string statement; std::getline(statements, statement, ';');)
        if (std::regex_search(statement, kExpects)) codes.merge(words(statement, R"(ErrorCode::(\w+))"));
    return codes;
}

TEST(Every_error_code, Is_expected_by_a_unit_test) {
    const fs::path source = KNEAD_SOURCE;
    const auto codes = words(text_of(source / "formats/include/knead/formats/result.h"), R"((\w+) = \d+,)");
    ASSERT_EQ(codes.size(), 15U);
    const auto expected = codes_in_expectations(texts_below(source / "tests/unit", ".cpp"));
    for (const std::string& code : codes)
        EXPECT_THAT(expected, testing::Contains(code));
}

TEST(Every_exit_code, Is_expected_by_a_case_of_the_programs) {
    const fs::path source = KNEAD_SOURCE;
    auto codes = words(text_of(source / "tools/common/exit_code.h"), R"(\w+ = (\d+),)");
    ASSERT_EQ(codes.size(), 7U);
    // An error of ours cannot be asked for: the frame of all tools is tested with a body that throws.
    codes.erase("70");
    EXPECT_THAT(words(text_of(source / "tests/unit/common/run_tool_test.cpp"), R"(exit_code, (\d+)\))"),
                testing::Contains("70"));
    const auto expected = words(texts_below(source / "tests/cli/cases", ".toml"), R"(exit = (\d+))");
    for (const std::string& code : codes)
        EXPECT_THAT(expected, testing::Contains(code));
}

}  // namespace
}  // namespace knead::test
