// SPDX-License-Identifier: Apache-2.0
#include "cli/sandbox.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace knead::test {
namespace {

namespace fs = std::filesystem;

std::string read_file(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// For /bin/sh: nothing inside single quotes means anything.
std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

}  // namespace

Sandbox::Sandbox(const std::string& name) {
    const fs::path top =
        fs::path(testing::TempDir()) / ("knead_cli_" + name + "_" + std::to_string(getpid()));
    fs::remove_all(top);
    folder_ = top / "work";
    beside_ = top / "printed";
    temporary_ = top / "temporary";
    fs::create_directories(folder_);
    fs::create_directories(beside_);
    fs::create_directories(temporary_);
}

Sandbox::~Sandbox() {
    std::error_code ignored;
    fs::remove_all(folder_.parent_path(), ignored);
}

void Sandbox::write(const std::string& file, const std::string& content) const {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file, std::ios::binary) << content;
}

Outcome Sandbox::run(const std::string& command) const {
    // The outer shell opens the files for the output, so that limits set by the command do not concern them
    // beyond what a terminal would: pipes through cat have no size limit.
    const std::string line = "cd " + quoted(folder_.string()) + " && PATH=" + quoted(KNEAD_BIN) +
                             ":$PATH LC_ALL=C TMPDIR=" + quoted(temporary_.string()) +
                             " && export PATH LC_ALL TMPDIR && { { /bin/sh -c " + quoted(command) +
                             " </dev/null 3>&- ; echo $? > ../printed/exit; } 2>&1 >&3 3>&- | cat > " +
                             "../printed/err 3>&- ; } 3>&1 | cat > ../printed/out";
    if (std::system(line.c_str()) == -1) throw std::runtime_error("cannot start /bin/sh");
    const std::string code = read_file(beside_ / "exit");
    return {code.empty() ? -1 : std::atoi(code.c_str()), read_file(beside_ / "out"),
            read_file(beside_ / "err")};
}

std::map<std::string, std::string> Sandbox::content() const {
    std::map<std::string, std::string> content;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
        const std::string path = fs::relative(entry.path(), folder_).generic_string();
        if (entry.is_directory())
            content[path + "/"];
        else
            content[path] = read_file(entry.path());
    }
    return content;
}

bool Sandbox::has_temporary_files() const {
    return !fs::is_empty(temporary_);
}

}  // namespace knead::test
