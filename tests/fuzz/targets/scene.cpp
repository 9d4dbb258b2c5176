// SPDX-License-Identifier: Apache-2.0
// Scene files.
#include "scene/scene.h"
#include "fuzz/text_target.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    fuzz::read_or_refuse([&] {
        const tools::Scene scene = tools::parse_scene(fuzz::text_of(data, size), "mutant.toml");
        fuzz::expect(!scene.name.empty() && !scene.levels.empty() && !scene.tools.empty(),
                     "a scene has a name, a level and a tool");
    });
}
