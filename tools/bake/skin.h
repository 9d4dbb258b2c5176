// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// A surface for drawing, finer than the tetrahedra that carry it. It need not be closed.
struct Skin {
    std::vector<Point> vertices_m;                        ///< no two at the same place
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertex indices
    std::vector<std::string> notes;                       ///< what the user should hear of the reading
};

/// Reads the whole content of an STL or PLY file (text or binary). Vertices stand in the order of their first
/// appearance in the file's triangles. Throws ToolError(bad_input) for anything else, for a content that is
/// at odds with the file name's extension (".stl"), and for a surface without triangles.
[[nodiscard]] Skin read_skin(std::string_view content, const std::string& extension, double metres_per_unit);

}  // namespace knead::tools
