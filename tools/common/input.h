// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "common/run_tool.h"
#include "knead/formats/read_stored.h"

namespace knead::tools {

/// One input of a tool as it was read: what it holds, and the hash that goes into the provenance of the
/// output.
template <class T>
struct Input {
    T value;
    std::string content_hash;
};

/// One of Knead's files. Told to the depfile before it is read. T as in read_stored(); throws
/// ToolError(bad_input).
template <class T>
[[nodiscard]] Input<T> read_input(ToolContext& context, const std::filesystem::path& file) {
    context.add_input(file);
    Stored<T> stored = value_or_throw(read_stored<T>(file));
    return {std::move(stored.value), std::move(stored.content_hash)};
}

/// The bytes of a file that is not one of Knead's, and their SHA-256. Told to the depfile before it is read.
/// Throws ToolError(bad_input), naming the file, when it cannot be read.
[[nodiscard]] Input<std::string> read_input_bytes(ToolContext& context, const std::filesystem::path& file);

/// Runs something that concerns a file, and names the file in front of what it complains about.
template <class Call>
auto about(const std::filesystem::path& file, const Call& call) {
    try {
        return call();
    } catch (const ToolError& error) {
        if (error.code() != ExitCode::bad_input) throw;
        throw ToolError(error.code(), file.string() + ": " + error.what());
    }
}

}  // namespace knead::tools
