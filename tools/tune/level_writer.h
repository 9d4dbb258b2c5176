// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "tune/recipe.h"
#include "tune/tuned_scene.h"

namespace knead::tools {

/// A level as a scene file says it.
struct WrittenLevel {
    std::string name;
    std::string toml;           ///< the [[level]] table, from its first line on
    bool needs_object = false;  ///< no key of a level makes it: the object goes into a file that it names
};

/// The [[level]] that makes what was found from the scene.
/// @param object_file the name that the table gives when the level needs one
[[nodiscard]] WrittenLevel level_for(const TunedScene& scene, std::size_t mesh, const Recipe& recipe,
                                     const std::string& object_file);

/// The text of a scene file with the level added, for a file in another folder: the files that it names are
/// found from there too.
/// @param text of the scene file, valid
[[nodiscard]] std::string scene_with_level(const std::string& text, const std::filesystem::path& scene_file,
                                           const std::string& level_toml,
                                           const std::filesystem::path& new_file);

}  // namespace knead::tools
