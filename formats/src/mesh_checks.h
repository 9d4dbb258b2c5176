// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead {

/// Checks nodes and tetrahedra as TetMesh describes. `group` is the place for messages ("/knead/mesh").
/// Throws Failure.
void check_mesh(const std::vector<Point>& nodes_m, const std::vector<Tetrahedron>& tetrahedra,
                const std::string& group);

/// Checks that names are unique, not empty, without zero bytes and not longer than a file can hold.
/// Throws Failure.
void check_names(const std::vector<std::string>& names, const char* what, const std::string& where);
void check_text(const std::string& text, const char* what, const std::string& where);

/// True for a material that a solver can use.
[[nodiscard]] bool is_positive(double value);
[[nodiscard]] bool is_poissons_ratio(double value);

inline constexpr const char* kNotPositive = "values are not finite and > 0";
inline constexpr const char* kNotPoissonsRatio = "values are not between -1 and 0.5 (both excluded)";

}  // namespace knead
