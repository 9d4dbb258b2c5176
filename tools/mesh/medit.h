// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "mesh/raw_mesh.h"

namespace knead::tools {

/// Reads a Medit mesh (.mesh, text). Vertices and tetrahedra are kept; other cells are counted as left out.
/// Regions: "reference_N" from the tetrahedra's reference numbers, when there is more than one.
/// Every word of the file must belong to the format: bad_input otherwise, with the line.
[[nodiscard]] RawMesh read_medit(std::string_view content);

}  // namespace knead::tools
