// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fuzz/mutant_file.h"
#include "knead/formats/inspect.h"

namespace knead::fuzz {

/// What a mutant may claim before the reader refuses: keeps memory and time small.
inline ReadLimits small_limits() {
    ReadLimits limits;
    limits.max_nodes = limits.max_tetrahedra = limits.max_overlap_entries = 100'000;
    limits.max_names = 64;
    limits.max_bytes = std::uint64_t{64} << 20;
    return limits;
}

template <class T>
void expect_good_manners(const Result<T>& result) {
    if (result.ok()) return;
    const Error& error = result.error();
    const int code = static_cast<int>(error.code);
    expect(code >= static_cast<int>(ErrorCode::io_error) &&
               code <= static_cast<int>(ErrorCode::invalid_argument),
           "the error has a code of the table");
    expect(error.code != ErrorCode::io_error && error.code != ErrorCode::cannot_write &&
               error.code != ErrorCode::invalid_argument,
           "the error is the file's, not the machine's or the caller's");
    expect(!error.message.empty() && !error.where.empty(), "the error says what and where");
}

/// One reader on one mutant. What it accepts must pass the checks once more.
template <class T>
void read_mutant(Result<T> (*read)(const std::filesystem::path&, const ReadLimits&),
                 const std::string& file) {
    const Result<T> result = read(file, small_limits());
    expect_good_manners(result);
    if (result.ok()) expect(validate(result.value()).ok(), "what was read is valid");
}

}  // namespace knead::fuzz
