// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace knead::tools {

/// Coarser versions of a mesh to try: cubes of every smaller number along their longest side from 3 on (at
/// most twelve of them, evenly), other meshes with 15 to 80 % of the tetrahedra.
/// @param tetrahedra of the mesh itself
[[nodiscard]] std::vector<MeshSource> coarser_meshes(const MeshSource& fine, std::size_t tetrahedra);

/// What differs from the fine mesh, for messages: "7 x 7 x 7 cubes", "1200 tetrahedra".
[[nodiscard]] std::string text_of(const MeshSource& source);

/// The TOML value of a level's `mesh` that makes `source` of a scene with this fine mesh; empty when more
/// than the size differs, which a line does not say.
[[nodiscard]] std::string level_mesh_toml(const MeshSource& source, const MeshSource& fine);

}  // namespace knead::tools
