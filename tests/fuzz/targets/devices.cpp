// SPDX-License-Identifier: Apache-2.0
// devices.toml.
#include "fuzz/text_target.h"
#include "touch/device_presets.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    fuzz::read_or_refuse([&] {
        for (const auto& preset : tools::parse_device_presets(fuzz::text_of(data, size), "mutant.toml"))
            fuzz::expect(preset.max_force_n.value > 0 && preset.apparent_mass_kg.value > 0,
                         "a device that is read has its numbers");
    });
}
