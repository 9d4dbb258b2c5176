// SPDX-License-Identifier: Apache-2.0
// Assets, as the runtime opens them; what is read is also loaded into a simulation's shoes by validate().
#include "fuzz/knead_target.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    fuzz::read_mutant<Asset>(read_asset, fuzz::mutant_file(data, size));
}
