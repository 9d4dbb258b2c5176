// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/veg.h"

namespace knead::tools {

/// Reads the files of one run and remembers what they were: role and SHA-256 of each, in order.
class SourceFiles {
  public:
    /// @param on_read told of every file before it is read
    explicit SourceFiles(std::function<void(const std::filesystem::path&)> on_read)
        : on_read_(std::move(on_read)) {}

    /// The whole file. ToolError bad_input when it cannot be read.
    std::string read(const std::filesystem::path& file, const std::string& role);

    /// Reads what `file` includes, and nothing that is not in its folder or below, links followed.
    IncludeReader include_reader(const std::filesystem::path& file);

    [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& hashes() const { return hashes_; }

  private:
    std::function<void(const std::filesystem::path&)> on_read_;
    std::vector<std::pair<std::string, std::string>> hashes_;
};

}  // namespace knead::tools
