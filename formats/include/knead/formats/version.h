// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace knead {

/// Version of this library and its tools.
inline constexpr const char* kLibraryVersion = "0.1.0";

/// Version of the file format, independent of the library's. Minor: additive; major: old readers would be
/// wrong. History in docs/format.md.
inline constexpr std::array<std::int32_t, 2> kFormatVersion{1, 2};

}  // namespace knead
