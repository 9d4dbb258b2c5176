// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "knead/plan.h"

namespace knead::tools {

/// What is remembered of each stage between two builds of a folder: what it was run with, on what, and what
/// came out, all by content hash. File times play no part. Kept in "<folder>/.knead-build.json"; losing it
/// costs a rebuild and nothing else.
class BuildState {
  public:
    /// A missing or unreadable state is an empty one.
    static BuildState load(const std::filesystem::path& folder);
    /// The same of the text of its file.
    static BuildState parse(std::string_view text, const std::filesystem::path& folder);
    void save() const;

    /// True when running `stage` with `program` would make the file that is there already.
    [[nodiscard]] bool up_to_date(const Stage& stage, const std::filesystem::path& program);

    /// Remembers a finished run. `dependencies`: every file that it read.
    void record(const Stage& stage, const std::filesystem::path& program,
                const std::vector<std::filesystem::path>& dependencies);

    /// Files that the recorded run of this stage read; empty when none is recorded.
    [[nodiscard]] std::vector<std::filesystem::path> dependencies(const Stage& stage) const;

  private:
    struct Entry {
        std::string command_hash;                                       ///< of the program and its arguments
        std::vector<std::pair<std::string, std::string>> dependencies;  ///< file, hash
        std::string output_hash;
    };

    std::string command_hash(const Stage& stage, const std::filesystem::path& program);

    std::filesystem::path file_;
    std::map<std::string, Entry> entries_;                   ///< by the output's file name
    std::map<std::filesystem::path, std::string> programs_;  ///< hashes of the tools, each read once
};

/// The prerequisites of a Makefile-style dependency file with one rule, unescaped.
/// Throws ToolError(bad_input) when it is not such a file.
[[nodiscard]] std::vector<std::filesystem::path> read_depfile(const std::filesystem::path& file);
/// The same of a text; `name` stands in messages.
[[nodiscard]] std::vector<std::filesystem::path> parse_depfile(std::string_view text,
                                                               const std::string& name);

}  // namespace knead::tools
