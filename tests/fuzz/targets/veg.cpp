// SPDX-License-Identifier: Apache-2.0
// VegaFEM files; *INCLUDE finds the file itself, half of it, and nothing.
#include "mesh/veg.h"

#include "fuzz/mesh_target.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    const tools::IncludeReader include = [&](const std::string& name) {
        if (name.size() % 3 == 0) tools::fail_input(name + ": no such file");
        return std::string(name.size() % 3 == 1 ? text : text.substr(size / 2));
    };
    fuzz::read_or_refuse([&] { fuzz::finish_mesh(tools::read_veg(text, include)); });
}
