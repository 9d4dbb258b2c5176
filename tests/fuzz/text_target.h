// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/error.h"
#include "fuzz/target.h"

namespace knead::fuzz {

/// Runs a reader of the tools. A file may be refused as bad input, with words; anything else that is thrown
/// would reach a user as "internal error" and counts as a crash here.
template <class Read>
void read_or_refuse(const Read& read) {
    try {
        read();
    } catch (const tools::ToolError& error) {
        expect(error.code() == tools::ExitCode::bad_input, "a file is refused as bad input");
        expect(error.what()[0] != '\0', "a refusal says why");
    }
}

}  // namespace knead::fuzz
