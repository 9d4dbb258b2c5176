// SPDX-License-Identifier: Apache-2.0
#include "baseline/machine.h"

#include <stdlib.h>
#include <sys/utsname.h>

#include <fstream>

namespace knead::baseline {
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

}  // namespace

Machine describe_machine() {
    Machine machine;
    machine.cpu = value_in("/proc/cpuinfo", "model name", ':');
#if defined(__clang__)
    machine.compiler = "clang " __clang_version__;
#else
    machine.compiler = "g++ " __VERSION__;
#endif
    machine.os = value_in("/etc/os-release", "PRETTY_NAME", '=');
    utsname name{};
    if (uname(&name) == 0) machine.os += std::string(", ") + name.sysname + " " + name.release;
    double average = 0;
    if (getloadavg(&average, 1) == 1) machine.load_average = average;
    return machine;
}

}  // namespace knead::baseline
