// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "bake/surface.h"
#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// An axis-aligned box; borders belong to it.
struct Box {
    Point low_m{};
    Point high_m{};

    [[nodiscard]] Point size_m() const {
        return {high_m[0] - low_m[0], high_m[1] - low_m[1], high_m[2] - low_m[2]};
    }
};

/// @pre at least one node
[[nodiscard]] Box bounding_box(const std::vector<Point>& nodes_m);

/// A part of an object's surface, independent of how the object is meshed: what looks along `facing` (within
/// 45 degrees) and lies in a box.
struct SurfaceRegion {
    Point facing{};  ///< unit length, outwards
    Box within;
};

/// A region on one mesh: its nodes and the integrals of their shape functions over the region's area.
///
/// Index meanings: rows and columns of `products_m2` and entries of `areas_m2` are positions in `nodes`.
struct MeshedRegion {
    std::vector<std::uint32_t> nodes;  ///< of all triangles that the region covers a part of; increasing
    std::vector<bool> is_inside;       ///< [nodes] the node itself is in the region's box
    std::vector<double> areas_m2;      ///< [nodes] integral of the shape function
    std::vector<double> products_m2;   ///< [nodes][nodes] integral of the product of two shape functions
    double area_m2 = 0;
};

/// Triangles that are covered in part are cut along the sides of the box, so that the area is the region's
/// own and does not depend on where the mesh happens to have nodes.
[[nodiscard]] MeshedRegion mesh_region(const TetMesh& mesh, const SurfaceRegion& region);
/// The same for many regions of one mesh.
/// @param outer boundary_triangles() of the mesh
[[nodiscard]] MeshedRegion mesh_region(const TetMesh& mesh, const std::vector<Triangle>& outer,
                                       const SurfaceRegion& region);

}  // namespace knead::tools
