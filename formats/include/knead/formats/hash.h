// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "knead/formats/result.h"

namespace knead {

/// SHA-256 of some bytes as 64 lowercase hexadecimal digits (FIPS 180-4).
[[nodiscard]] std::string sha256_of(std::string_view bytes);

/// SHA-256 of a whole file as it lies on the disk; what provenance records of an input that is not Knead's.
/// @return the digits, or io_error
Result<std::string> sha256_of_file(const std::filesystem::path& file);

}  // namespace knead
