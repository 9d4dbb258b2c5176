// SPDX-License-Identifier: GPL-3.0-or-later
#include "knead/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

#include "common/error.h"

extern char** environ;

namespace knead::tools {
namespace {

struct Pipe {
    int read_end = -1;
    int write_end = -1;
    Pipe() {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
        read_end = ends[0];
        write_end = ends[1];
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe() {
        close(read_end);
        close_write_end();
    }
    void close_write_end() {
        if (write_end >= 0) close(write_end);
        write_end = -1;
    }
};

pid_t spawn(const std::filesystem::path& program, const std::vector<std::string>& arguments,
            const Pipe& errors) {
    std::vector<char*> argv;
    const std::string name = program.string();
    argv.push_back(const_cast<char*>(name.c_str()));  // posix_spawn's signature; it does not write to them
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, errors.write_end, STDERR_FILENO);
    pid_t child = 0;
    const int failed = posix_spawn(&child, name.c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) fail_usage(name + ": cannot be started: " + std::strerror(failed));
    return child;
}

}  // namespace

int run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
              const std::function<void(std::string_view)>& on_stderr) {
    Pipe errors;
    const pid_t child = spawn(program, arguments, errors);
    errors.close_write_end();
    std::array<char, 4096> buffer{};
    for (;;) {
        const ssize_t count = read(errors.read_end, buffer.data(), buffer.size());
        if (count > 0) on_stderr({buffer.data(), static_cast<std::size_t>(count)});
        if (count == 0 || (count < 0 && errno != EINTR)) break;
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::filesystem::path find_tool(const std::string& name) {
    std::error_code error;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
    if (!error && access((self.parent_path() / name).c_str(), X_OK) == 0) return self.parent_path() / name;
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const auto candidate = std::filesystem::path(folder) / name;
        if (access(candidate.c_str(), X_OK) == 0) return candidate;
    }
    fail_usage(name + ": not found beside knead or on PATH");
}

}  // namespace knead::tools
