// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "mesh/gmsh_mesher.h"
#include "mesh/recognise.h"

namespace knead::tools {

/// Reads a gmsh MSH file (versions 1, 2 and 4, text or binary): physical volumes become regions, element data
/// with one number per tetrahedron become cell arrays. Precondition: recognise(content) == FileFormat::msh.
/// bad_input where gmsh refuses it.
[[nodiscard]] RawMesh read_msh(std::string_view content);

/// Meshes the solids of a STEP or BREP file; several become regions "volume_1", ... that share their faces.
/// @param metres_per_unit of a BREP file; a STEP file knows its unit
/// bad_input where OpenCASCADE refuses it or it has no solid.
[[nodiscard]] GeneratedMesh mesh_cad(std::string_view content, FileFormat format, double metres_per_unit,
                                     const MeshSize& size);

}  // namespace knead::tools
