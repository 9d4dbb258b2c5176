// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "mesh/raw_mesh.h"

namespace knead::tools {

/// Gives the text of a file that *INCLUDE names; throws ToolError when it may not be read.
using IncludeReader = std::function<std::string(const std::string& name)>;

/// Reads a VegaFEM volumetric mesh (.veg): *VERTICES, *ELEMENTS (TET), *MATERIAL (ENU), *SET, *REGION,
/// *INCLUDE, and # comments. Numbers start at 1 or at 0, as the first vertex and the first element say.
///
/// Regions: one per *REGION, named after its set; later regions win where two overlap, as in VegaFEM. When
/// every tetrahedron has an ENU material: cell arrays youngs_modulus_pa, poissons_ratio, density_kg_per_m3.
/// bad_input with the line for everything that does not belong there.
[[nodiscard]] RawMesh read_veg(std::string_view content, const IncludeReader& include);

}  // namespace knead::tools
