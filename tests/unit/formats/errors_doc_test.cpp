// SPDX-License-Identifier: Apache-2.0
// docs/errors.md repeats two enums of the source; here both are read as text and compared.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>

namespace knead::test {
namespace {

std::string text_of(const std::string& file) {
    std::ifstream stream(std::string(KNEAD_SOURCE) + "/" + file);
    EXPECT_TRUE(stream) << file;
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::map<int, std::string> matches(const std::string& text, const std::string& pattern, int number,
                                   int name) {
    std::map<int, std::string> found;
    const std::regex regex(pattern);
    for (std::sregex_iterator i(text.begin(), text.end(), regex), end; i != end; ++i)
        EXPECT_TRUE(found.emplace(std::stoi((*i)[number]), (*i)[name]).second) << i->str();
    return found;
}

std::map<int, std::string> enumerators(const std::string& file) {
    return matches(text_of(file), R"((\w+) = (\d+),)", 2, 1);
}

std::map<int, std::string> table(const std::string& from, const std::string& to) {
    const std::string text = text_of("docs/errors.md");
    const std::size_t begin = text.find(from), end = to.empty() ? text.size() : text.find(to);
    EXPECT_NE(begin, std::string::npos);
    return matches(text.substr(begin, end - begin), R"(\| (\d+) \| `(\w+)` \|)", 1, 2);
}

TEST(Documentation_of_the_error_codes, Lists_those_of_the_header) {
    const auto codes = enumerators("formats/include/knead/formats/result.h");
    EXPECT_EQ(codes.size(), 15U);
    EXPECT_EQ(table("## Error codes", "## Exit codes"), codes);
}

TEST(Documentation_of_the_exit_codes, Lists_those_of_the_header) {
    const auto codes = enumerators("tools/common/exit_code.h");
    EXPECT_EQ(codes.size(), 7U);
    EXPECT_EQ(table("## Exit codes", ""), codes);
}

}  // namespace
}  // namespace knead::test
