// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "fuzz/target.h"

namespace knead::fuzz {

/// The input as a file in memory, for readers that open files by name. One per process, written over.
inline const std::string& mutant_file(const std::uint8_t* data, std::size_t size) {
    static const std::string path =
        (std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path()) /
        ("knead-mutant-" + std::to_string(::getpid()) + ".hdf");
    static const int file = [] {
        std::atexit([] { ::unlink(path.c_str()); });
        return ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    }();
    const bool written =
        file >= 0 && ::ftruncate(file, 0) == 0 && ::pwrite(file, data, size, 0) == static_cast<ssize_t>(size);
    if (!written) std::_Exit(2);  // the machine, not the reader
    return path;
}

}  // namespace knead::fuzz
