// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "mesh/raw_mesh.h"

namespace knead::tools {

/// Reads a legacy VTK file (text or binary, versions 1 to 5) that holds an unstructured grid. Tetrahedra are
/// kept; other cells are counted as left out. Cell data with one number per cell become cell arrays; cell
/// data with more and all point data are left out and told. bad_input with the line for what does not belong
/// there.
///
/// Own reader, because that of gmsh 4.8 drops all data and does not know version 5.
[[nodiscard]] RawMesh read_vtk(std::string_view content);

}  // namespace knead::tools
