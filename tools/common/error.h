// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "common/exit_code.h"
#include "knead/formats/result.h"

namespace knead::tools {

/// The one exception of the tools: an exit code and a message for the user. run_tool() catches it.
/// Messages name the file, the place in it, how many elements are concerned and the first ids.
class ToolError : public std::runtime_error {
  public:
    ToolError(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    [[nodiscard]] ExitCode code() const noexcept { return code_; }

  private:
    ExitCode code_;
};

[[noreturn]] inline void fail_usage(const std::string& message) {
    throw ToolError(ExitCode::bad_usage, message);
}
[[noreturn]] inline void fail_input(const std::string& message) {
    throw ToolError(ExitCode::bad_input, message);
}
[[noreturn]] inline void fail_result(const std::string& message) {
    throw ToolError(ExitCode::no_valid_result, message);
}

/// The value of a result of formats, or its error as a ToolError with the exit code that fits.
template <class T>
T value_or_throw(Result<T> result) {
    if (result.ok()) return std::move(result).value();
    const Error& error = result.error();
    ExitCode code = ExitCode::bad_input;
    if (error.code == ErrorCode::cannot_write) code = ExitCode::cannot_write;
    if (error.code == ErrorCode::out_of_memory) code = ExitCode::no_valid_result;  // as of an std::bad_alloc
    throw ToolError(code, error.text());
}

}  // namespace knead::tools
