// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/gmsh_mesher.h"
#include "mesh/surface.h"

namespace knead::tools {

/// Fills a closed surface with tetrahedra. Without a wished size the surface's own triangles stay as they
/// are; with one the surface is meshed anew (edges sharper than 40 degrees are kept). Cavities stay empty;
/// several bodies become several volumes of one mesh. Errors: no_valid_result when gmsh cannot, for instance
/// where the surface cuts itself.
[[nodiscard]] GeneratedMesh mesh_surface(const ClosedSurface& closed, const MeshSize& size,
                                         double metres_per_unit);

}  // namespace knead::tools
