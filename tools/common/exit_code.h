// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace knead::tools {

/// What every tool returns to its caller. docs/errors.md repeats the table; a test compares the two.
enum class ExitCode : int {
    done = 0,
    answer_is_no = 1,     ///< ran, and the answer is no: validate, diff, evaluate --fail-above
    bad_usage = 2,        ///< the command line
    bad_input = 3,        ///< an input file or the values in it
    cannot_write = 4,     ///< the output
    no_valid_result = 5,  ///< the input is fine, but nothing valid can be made of it
    bug = 70,             ///< an error of ours
};

}  // namespace knead::tools
