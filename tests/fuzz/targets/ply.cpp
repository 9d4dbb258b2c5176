// SPDX-License-Identifier: Apache-2.0
#include "fuzz/mesh_target.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    fuzz::read_or_refuse([&] { fuzz::finish_surface(tools::read_ply(fuzz::text_of(data, size))); });
}
