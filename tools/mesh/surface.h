// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "knead/formats/tet_mesh.h"
#include "mesh/notes.h"

namespace knead::tools {

/// Triangles in space, in the file's length unit. Points with the same coordinates are one point.
struct TriangleSurface {
    std::vector<Point> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    Notes notes;  ///< what the reader has to say
};

/// Readers. They check the whole text or buffer, refuse what does not belong there and every coordinate that
/// is not finite (ToolError bad_input), and leave out triangles with a repeated corner (a note says how
/// many).
[[nodiscard]] TriangleSurface read_stl_text(std::string_view content);
[[nodiscard]] TriangleSurface read_stl_binary(std::string_view content);
[[nodiscard]] TriangleSurface read_ply(std::string_view content);

/// Makes a surface of loose corners, three per triangle: joins equal points in order of first appearance.
[[nodiscard]] TriangleSurface join_corners(const std::vector<Point>& corners);

/// The bodies a closed surface bounds.
struct ClosedSurface {
    TriangleSurface surface;
    std::vector<std::uint32_t> shell_of_triangle;  ///< [triangles] connected component
    /// Shells of each body: its outside first, then the cavities in it.
    std::vector<std::vector<std::uint32_t>> bodies;
};

/// Sorts the triangles into shells and bodies. Refuses (bad_input) a surface with open edges or with edges
/// shared by more than two triangles: says how many and where the first is.
[[nodiscard]] ClosedSurface require_closed(TriangleSurface surface);

}  // namespace knead::tools
