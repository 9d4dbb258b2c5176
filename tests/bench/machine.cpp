// SPDX-License-Identifier: Apache-2.0
#include "bench/machine.h"

#include <sched.h>
#include <sys/utsname.h>

#include <fstream>
#include <stdexcept>

#include "bench/core_speed.h"

namespace knead::bench {
namespace {

/// The value of the first line that starts with `key`, after its separator and without quotes.
std::string value_in(const char* file, const std::string& key, char separator) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        const std::size_t at = line.find(separator);
        if (line.compare(0, key.size(), key) != 0 || at == std::string::npos) continue;
        std::string value = line.substr(at + 1);
        value.erase(0, value.find_first_not_of(" \""));
        value.erase(value.find_last_not_of(" \"") + 1);
        return value;
    }
    return "unknown";
}

void pin(int core) {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    if (core < 0 || core >= CPU_SETSIZE) throw std::runtime_error("no such core");
    CPU_SET(static_cast<unsigned>(core), &cores);
    if (sched_setaffinity(0, sizeof cores, &cores) != 0)
        throw std::runtime_error("cannot pin to core " + std::to_string(core));
}

}  // namespace

Machine describe_machine(std::optional<int> core) {
    Machine machine;
    if (core) pin(*core);
    machine.core = core.value_or(-1);
    machine.cpu = value_in("/proc/cpuinfo", "model name", ':');
    machine.isa = instruction_set();
#if defined(__clang__)
    machine.compiler = "clang " __clang_version__;
#else
    machine.compiler = "g++ " __VERSION__;
#endif
    machine.flags = KNEAD_BENCH_FLAGS;
    utsname name{};
    machine.os = value_in("/etc/os-release", "PRETTY_NAME", '=');
    if (uname(&name) == 0) machine.os += std::string(", ") + name.sysname + " " + name.release;
    return machine;
}

}  // namespace knead::bench
