// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "bake/skin.h"
#include "evaluate/evaluation.h"
#include "evaluate/level_mesh.h"
#include "evaluate/static_answer.h"
#include "scene/scene.h"

namespace knead::tools {

/// A mesh of a scene with everything about it that does not depend on the elasticities.
struct PreparedMesh {
    LevelMesh level;
    MeshSource source;                 ///< what the mesh was made from; a mesh of a method's own: the level's
    std::string hash;                  ///< of nodes and tetrahedra
    std::vector<bool> is_held;         ///< [nodes]
    std::vector<MeshLoad> loads;       ///< [loads of the request]
    std::vector<std::uint32_t> outer;  ///< surface nodes
    std::vector<Interpolated> places;  ///< [outer] where they lie in the reference's mesh
};

/// A scene, its meshes and the loads on each of them.
struct PreparedScene {
    Scene scene;
    Skin skin;
    PreparedMesh fine;                 ///< without overlap, outer nodes and places
    PreparedMesh reference;            ///< what the reference is solved on: fine, or cut in eight
    std::vector<PreparedMesh> levels;  ///< in the order of the request
    std::vector<std::string> notes;
};

/// Reads and meshes a scene and lays every load on every mesh.
/// @throws ToolError when the scene is bad, or a level or a load is not to be had
[[nodiscard]] PreparedScene prepare(const std::filesystem::path& file, const EvaluationRequest& request,
                                    const FileReader& read);

/// Where a level of this name or number of tetrahedra gets its mesh from; nothing: the fine mesh.
/// @throws ToolError(bad_usage), with the nearest name, when there is no such level
[[nodiscard]] std::optional<MeshSource> level_source(const Scene& scene, const std::string& level);
/// The different meshes of the scene's levels; the fine one only if there is no other.
[[nodiscard]] std::vector<std::string> default_levels(const Scene& scene);

/// Sets up a further mesh of a prepared scene, for methods that make one of their own.
[[nodiscard]] PreparedMesh prepare_mesh(const PreparedScene& prepared, TetMesh mesh, bool is_fine,
                                        const std::vector<std::string>& loads);

/// The asset of a material on a mesh: all that the scene asks for.
[[nodiscard]] Asset bake_level(const PreparedScene& prepared, const MaterialObject& object);

/// Of a prepared mesh with these elasticities: names a result's object in the cache.
[[nodiscard]] std::string hash_of(const PreparedMesh& mesh, const Material& material);

/// Over the mesh's surface nodes: |u - u_reference| / |u_reference|, root mean squares.
[[nodiscard]] double displacement_error(const PreparedMesh& mesh, const StaticAnswer& answer,
                                        const StaticAnswer& reference);

}  // namespace knead::tools
