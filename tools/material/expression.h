// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// Value of an expression of x, y and z at the barycentre of every tetrahedron.
///
/// Coordinates are metres, the value is in pascals. muParser's operators, functions and constants apply
/// ("z < 0.02 ? 40e3 : 4e3 + 1e5*x"); an assignment is refused.
/// @throws bad_usage when the text is not an expression of x, y, z, with the place
[[nodiscard]] std::vector<double> evaluate_expression(const TetMesh& mesh, const std::string& expression);

/// Name and version of the library behind it.
[[nodiscard]] std::string expression_library();

}  // namespace knead::tools
