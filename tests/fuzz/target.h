// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace knead::fuzz {

/// One call is one hostile file. Each target defines it; entry.cpp calls it for libFuzzer with mutants, and
/// for replay.cpp with kept files. What it must not do: crash, leak, take more than a second, take more than
/// 512 MB. What a reader makes of a file is also looked at: see expect().
void read_hostile_file(const std::uint8_t* data, std::size_t size);

/// Ends the program, which both drivers report as a crash of the input in hand.
inline void expect(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "expectation failed: %s\n", what);
    std::abort();
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

}  // namespace knead::fuzz
