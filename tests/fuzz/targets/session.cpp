// SPDX-License-Identifier: Apache-2.0
// Session logs, as knead-touch --replay opens them.
#include "fuzz/knead_target.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    fuzz::read_mutant<SessionLog>(read_session_log, fuzz::mutant_file(data, size));
}
