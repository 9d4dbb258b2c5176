// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace knead::test {

/// A new folder with the golden stage files, so that every tool has its input at once. Removed at the end.
class WorkFolder {
  public:
    explicit WorkFolder(const std::string& name)
        : top_(std::filesystem::path(testing::TempDir()) /
               ("knead_crash_" + name + "_" + std::to_string(getpid()))) {
        std::filesystem::remove_all(top_);
        std::filesystem::create_directories(top_);
        std::filesystem::copy(KNEAD_GOLDEN, path());
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    ~WorkFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(top_, ignored);
    }
    [[nodiscard]] std::filesystem::path path() const { return top_ / "work"; }
    [[nodiscard]] std::filesystem::path operator/(const std::string& file) const { return path() / file; }

  private:
    std::filesystem::path top_;
};

}  // namespace knead::test
