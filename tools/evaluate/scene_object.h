// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "knead/formats/material.h"
#include "scene/scene.h"

namespace knead::tools {

/// Gives the content of a file that a scene names.
using FileReader = std::function<std::string(const std::filesystem::path&)>;

/// Makes the mesh that a scene or a level asks for, as knead-mesh does.
/// @throws ToolError as knead-mesh; messages of files begin with the file's name
[[nodiscard]] TetMesh make_mesh(const MeshSource& source, const FileReader& read);

/// The elasticities of the fine mesh, as knead-material makes them.
/// @param seed replaces the scene's where the material is drawn (scenarios)
/// @throws ToolError as knead-material
[[nodiscard]] Material make_scene_material(const Scene& scene, const TetMesh& mesh, std::uint64_t seed,
                                           const FileReader& read);

/// Whether another seed gives another material.
[[nodiscard]] inline bool draws_material(const Scene& scene) {
    return scene.material.scenario.has_value();
}

/// Every tetrahedron cut into eight at the middles of its edges (Bey's refinement: the inner octahedron along
/// its shortest diagonal, ties by the lowest node), with the values of the tetrahedron that it comes from.
/// Old nodes keep their indices; children 8 t to 8 t + 7 are those of tetrahedron t.
[[nodiscard]] MaterialObject split_in_eight(const MaterialObject& object);

}  // namespace knead::tools
