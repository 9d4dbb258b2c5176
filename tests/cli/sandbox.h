// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace knead::test {

struct Outcome {
    int exit_code = 0;  ///< 128 + number if a signal ended the command
    std::string out;
    std::string err;
};

/// An empty folder in which commands run; removed at the end.
class Sandbox {
  public:
    explicit Sandbox(const std::string& name);
    ~Sandbox();
    Sandbox(const Sandbox&) = delete;
    Sandbox& operator=(const Sandbox&) = delete;

    void write(const std::string& file, const std::string& content) const;

    /// Runs a command with /bin/sh in the folder, the built programs first in PATH, nothing on its stdin.
    [[nodiscard]] Outcome run(const std::string& command) const;

    /// Content of every file in the folder and below, by path; folders end in '/' and have no content.
    [[nodiscard]] std::map<std::string, std::string> content() const;

    /// True if programs left something in the folder for temporary files.
    [[nodiscard]] bool has_temporary_files() const;

  private:
    std::filesystem::path folder_;     ///< where commands run
    std::filesystem::path beside_;     ///< what they print
    std::filesystem::path temporary_;  ///< their TMPDIR
};

}  // namespace knead::test
