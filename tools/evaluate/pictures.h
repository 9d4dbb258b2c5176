// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "knead/formats/asset.h"
#include "knead/formats/material.h"

namespace knead::tools {

/// One state of the object on its way through the method (paper, Figure 3).
struct ObjectState {
    std::string name;  ///< "C1 initial", "C2 clustered", "C3 homogenised", "C4 aggregated", "C5 coarse"
    MaterialObject object;
    std::vector<std::uint32_t> cluster;  ///< [tetrahedra] or empty; bins are those of the material
};

/// The states of an object up to the fourth, with the paper's defaults.
[[nodiscard]] std::vector<ObjectState> fine_states(const MaterialObject& fine, std::uint32_t bins,
                                                   std::uint32_t clusters, std::uint64_t seed);

/// A group of an asset's file, or one that it could have and has not.
struct AssetGroup {
    std::string group;
    std::uint64_t bytes = 0;
    std::string asked_for_by;  ///< "tool[0], line 66", or empty
    bool left_out = false;
    std::string why;
};

/// What is in the file of an asset, group by group, and what was left out.
[[nodiscard]] std::vector<AssetGroup> asset_groups(const Asset& asset, const std::filesystem::path& file);

}  // namespace knead::tools
