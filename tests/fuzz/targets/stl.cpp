// SPDX-License-Identifier: Apache-2.0
// STL, text and binary.
#include "fuzz/mesh_target.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    const std::string_view content = fuzz::text_of(data, size);
    fuzz::read_or_refuse([&] { fuzz::finish_surface(tools::read_stl_text(content)); });
    fuzz::read_or_refuse([&] { fuzz::finish_surface(tools::read_stl_binary(content)); });
}
