// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "mesh/gmsh_mesher.h"

namespace knead::tools {

// Solids of OpenCASCADE, meshed by gmsh. All lengths in metres, > 0 and finite (bad_usage otherwise); z is
// up. Errors: bad_usage, no_valid_result when gmsh cannot make the geometry or the mesh.

/// The box [0, size].
[[nodiscard]] GeneratedMesh mesh_box(const std::array<double, 3>& size_m, const MeshSize& size);
/// The ball around the origin.
[[nodiscard]] GeneratedMesh mesh_sphere(double radius_m, const MeshSize& size);
/// The cylinder around the z axis from z = 0 to the height.
[[nodiscard]] GeneratedMesh mesh_cylinder(double radius_m, double height_m, const MeshSize& size);
/// The ellipsoid around the origin with its axes along x, y, z.
[[nodiscard]] GeneratedMesh mesh_ellipsoid(const std::array<double, 3>& radii_m, const MeshSize& size);

/// A slab: an outline in the plane z = 0, raised to z = thickness.
struct OutlineSlab {
    std::vector<std::array<double, 2>> corners_m;  ///< read_outline(), in metres
    double thickness_m = 0;
    bool polygon = false;  ///< straight sides instead of a smooth closed curve through the corners
    double round_m = 0;    ///< radius of the rounded upper and lower edges, 0 for sharp ones
};
[[nodiscard]] GeneratedMesh mesh_outline(const OutlineSlab& slab, const MeshSize& size);

}  // namespace knead::tools
