// SPDX-License-Identifier: Apache-2.0
// What knead build reads back from its folder: its own state, and the dependency files of the stages.
#include "knead/build_state.h"

#include "fuzz/mutant_file.h"
#include "fuzz/text_target.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    const std::string text(fuzz::text_of(data, size));
    (void)tools::BuildState::parse(text, "folder");
    fuzz::read_or_refuse([&] { (void)tools::parse_depfile(text, "mutant.d"); });
}
