// SPDX-License-Identifier: Apache-2.0
#include "mesh/outline.h"

#include "fuzz/text_target.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    fuzz::read_or_refuse([&] {
        fuzz::expect(tools::read_outline(fuzz::text_of(data, size)).size() >= 3, "an outline has corners");
    });
}
