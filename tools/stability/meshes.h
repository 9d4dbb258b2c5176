// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "knead/formats/material.h"
#include "knead/formats/tet_mesh.h"

namespace knead::tools::stability {

/// A box [0, size] of cells that are cut into six tetrahedra each, along the cell's diagonal (Kuhn).
[[nodiscard]] TetMesh box_mesh(const std::array<std::uint32_t, 3>& cells, const Point& size_m);

/// A cube [0, side] whose cells shrink towards the corner at the origin in shells of half the size each:
/// tetrahedra of the same shapes, edges from about side / 2 down to that over `ratio` (a power of two).
[[nodiscard]] TetMesh graded_corner(double side_m, std::uint32_t ratio);

/// How a tetrahedron is spoilt: by a fifth node close to the middle of a face, or of an edge.
enum class Flaw : std::uint8_t { near_face, near_edge };

/// `mesh` with every `every`-th tetrahedron cut in four about a node so close to a face or an edge that the
/// smallest dihedral angle is `angle_rad`.
[[nodiscard]] TetMesh with_slivers(const TetMesh& mesh, Flaw flaw, double angle_rad, std::size_t every);

/// Smallest angle between two faces of a tetrahedron, over all of them, radians.
[[nodiscard]] double smallest_dihedral_rad(const TetMesh& mesh);

/// Two meshes that share nothing, as one.
[[nodiscard]] TetMesh side_by_side(const TetMesh& a, const TetMesh& b, const Point& b_moved_m);

/// Where the stiff matter of a cube of two materials lies.
enum class Layout : std::uint8_t {
    percolating,  ///< half of the tetrahedra, drawn at random: paths of stiff matter from face to face
    islands       ///< single cells that share no node with one another nor with the border
};

/// A cube of soft matter (4 kPa) with stiff matter of `contrast` times its elasticity.
[[nodiscard]] MaterialObject contrast_cube(std::uint32_t cells, double side_m, double poissons_ratio,
                                           double contrast, Layout layout);

}  // namespace knead::tools::stability
