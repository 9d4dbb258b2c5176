// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace knead::tools {

/// One run of one tool. The command line is what a build script would write; nothing else is passed.
struct Stage {
    std::string tool;                    ///< "knead-overlap"
    std::vector<std::string> arguments;  ///< without --threads and --depfile
    std::filesystem::path output;        ///< also stands in `arguments`
    bool threaded = false;               ///< the tool takes --threads

    bool operator==(const Stage&) const = default;
};

/// As a shell would take it.
[[nodiscard]] std::string command_line(const Stage& stage);

/// The asset that a level ends in.
struct PlannedAsset {
    std::string level;
    std::filesystem::path file;
    std::filesystem::path object;  ///< mesh and material that it is baked from
};

struct Plan {
    std::vector<Stage> stages;  ///< in an order in which every input is made before it is read
    std::vector<PlannedAsset> assets;
    std::filesystem::path fine_object;  ///< mesh and raw elasticities
};

/// The stages from the scene file to the asset of each of `levels` (names; empty: all of the scene's).
///
/// Files are named <scene>.<stage>.hdf and <scene>.<level>.<stage>.hdf in `folder`, the asset
/// <scene>.<level>.hdf. Levels that coarsen to the same mesh share it and its overlap.
[[nodiscard]] Plan plan_build(const Scene& scene, const std::vector<std::string>& levels,
                              const std::filesystem::path& folder);

}  // namespace knead::tools
