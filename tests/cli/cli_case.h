// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace knead::test {

/// One run of a program and what must come of it; the fields are those of README.md.
struct CliCase {
    std::string name;
    std::map<std::string, std::string> files;
    std::vector<std::string> setup;
    std::string command;
    int exit_code = 0;
    std::vector<std::string> stderr_patterns;
    std::vector<std::string> stdout_patterns;
    std::set<std::string> creates;
};

/// Cases of every .toml file in the folder, those that each [[tool]] stands for included, by file and place.
/// @throws std::runtime_error naming the file, the case and what is wrong with it
[[nodiscard]] std::vector<CliCase> read_cases(const std::filesystem::path& folder);

}  // namespace knead::test
