// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/read.h"
#include "knead/runtime/embedded_surface.h"
#include "knead/runtime/simulation.h"

namespace knead {

Result<Simulation> Simulation::load(const std::filesystem::path& asset_file, const SimulationConfig& config) {
    Result<Asset> asset = read_asset(asset_file);
    if (!asset) return asset.error();
    return create(asset.value(), config);
}

Result<EmbeddedSurface> EmbeddedSurface::load(const std::filesystem::path& asset_file) {
    Result<Asset> asset = read_asset(asset_file);
    if (!asset) return asset.error();
    return create(asset.value());
}

}  // namespace knead
