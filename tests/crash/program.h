// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>

namespace knead::test {

/// A program of the build tree, running in a folder and in a process group of its own.
class Program {
  public:
    /// @param command for /bin/sh, one simple command; standard output and error go to ../printed
    Program(const std::string& command, const std::filesystem::path& folder);
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program();

    /// kill -9. @param children also those that it started
    void kill(bool children);
    /// Waits for the end. @return its exit code, or 128 + the signal
    int wait();

  private:
    pid_t pid_ = -1;
    int code_ = -1;
};

/// Starts and waits.
int run(const std::string& command, const std::filesystem::path& folder);

/// Waits until something of that name is created in a folder: the moment when a tool begins to write.
class Creation {
  public:
    explicit Creation(const std::filesystem::path& folder);
    Creation(const Creation&) = delete;
    Creation& operator=(const Creation&) = delete;
    ~Creation();
    /// @return false when nothing whose name holds `part` came within `seconds`
    bool wait(const std::string& part, double seconds) const;

  private:
    int descriptor_;
};

/// Name to content of the files of a folder and below.
std::map<std::string, std::string> content_of_folder(const std::filesystem::path& folder);

void wait_us(double microseconds);

}  // namespace knead::test
