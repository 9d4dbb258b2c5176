// SPDX-License-Identifier: Apache-2.0
#include "crash/program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/inotify.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace knead::test {

namespace fs = std::filesystem;

Program::Program(const std::string& command, const fs::path& folder) {
    const std::string line = "exec " + command;
    const std::string path = std::string(KNEAD_BIN) + ":" + std::getenv("PATH");
    const std::string printed = (folder.parent_path() / "printed").string();
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error("cannot fork");
    if (pid_ > 0) {
        (void)setpgid(pid_, pid_);  // here and there: whoever comes first
        return;
    }
    (void)setpgid(0, 0);
    const int out = open(printed.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (out < 0 || dup2(out, STDOUT_FILENO) < 0 || dup2(out, STDERR_FILENO) < 0 ||
        chdir(folder.c_str()) != 0 || setenv("PATH", path.c_str(), 1) != 0)
        _exit(127);
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
}

Program::~Program() {
    if (code_ >= 0) return;
    kill(true);
    (void)wait();
}

void Program::kill(bool children) {
    if (code_ < 0) (void)::kill(children ? -pid_ : pid_, SIGKILL);
}

int Program::wait() {
    if (code_ >= 0) return code_;
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return code_;
}

int run(const std::string& command, const fs::path& folder) {
    return Program(command, folder).wait();
}

Creation::Creation(const fs::path& folder) : descriptor_(inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
    if (descriptor_ < 0 || inotify_add_watch(descriptor_, folder.c_str(), IN_CREATE) < 0)
        throw std::runtime_error("cannot watch " + folder.string());
}

Creation::~Creation() {
    close(descriptor_);
}

bool Creation::wait(const std::string& part, double seconds) const {
    pollfd watched{descriptor_, POLLIN, 0};
    alignas(inotify_event) std::array<char, 4096> buffer{};
    while (poll(&watched, 1, static_cast<int>(1000 * seconds)) > 0) {
        const ssize_t size = read(descriptor_, buffer.data(), buffer.size());
        for (ssize_t at = 0; at < size;) {
            inotify_event event{};
            std::memcpy(&event, buffer.data() + at, sizeof event);
            if (event.len > 0 &&
                std::string(buffer.data() + at + sizeof event).find(part) != std::string::npos)
                return true;
            at += static_cast<ssize_t>(sizeof event + event.len);
        }
    }
    return false;
}

std::map<std::string, std::string> content_of_folder(const fs::path& folder) {
    std::map<std::string, std::string> content;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        std::ifstream stream(entry.path(), std::ios::binary);
        content[fs::relative(entry.path(), folder).generic_string()] = {
            std::istreambuf_iterator<char>(stream), {}};
    }
    return content;
}

void wait_us(double microseconds) {
    timespec time{static_cast<time_t>(microseconds / 1e6),
                  static_cast<long>(microseconds * 1e3) % 1'000'000'000};
    (void)nanosleep(&time, nullptr);
}

}  // namespace knead::test
