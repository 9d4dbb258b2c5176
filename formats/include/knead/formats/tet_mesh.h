// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "knead/formats/result.h"

namespace knead {

using Point = std::array<double, 3>;               ///< metres
using Tetrahedron = std::array<std::uint32_t, 4>;  ///< node indices

/// A named value per tetrahedron that came with the mesh (an array of a .vtk file, a VegaFEM material).
/// Carried so that knead-material can pick it up; units are those of its name.
struct CellArray {
    std::string name;
    std::vector<double> values;  ///< [tetrahedra]
};

/// A named set of tetrahedra: a gmsh physical volume, a VegaFEM region. Regions partition the mesh.
struct Regions {
    std::vector<std::string> names;  ///< unique, not empty
    std::vector<std::uint32_t>
        region_of_tetrahedron;  ///< [tetrahedra] index into names, or empty: no regions
};

/// A tetrahedral mesh in its rest state, in metres.
///
/// On disk: group "/knead/mesh" (docs/format.md). Written by knead-mesh, read by every later tool.
///
/// Invariants, checked by validate() and again by every reader:
///   - at least one tetrahedron; every index < nodes_m.size()
///   - every coordinate finite; every node used by at least one tetrahedron
///   - every tetrahedron has four different nodes and a positive volume: with a, b, c, d its nodes,
///     dot(b - a, cross(c - a, d - a)) > 0
///   - cell array names unique and not empty, their lengths and that of regions match the tetrahedra
struct TetMesh {
    std::vector<Point> nodes_m;
    std::vector<Tetrahedron> tetrahedra;
    Regions regions;
    std::vector<CellArray> cell_arrays;
};

/// Signed volume of one tetrahedron, m^3.
[[nodiscard]] double signed_volume_m3(const Point& a, const Point& b, const Point& c, const Point& d);
[[nodiscard]] double signed_volume_m3(const TetMesh& mesh, std::size_t tetrahedron);

/// Centre of gravity of one tetrahedron.
[[nodiscard]] Point barycentre_m(const TetMesh& mesh, std::size_t tetrahedron);

/// Checks every invariant above; the message names how many elements break it and the first ids.
[[nodiscard]] Status validate(const TetMesh& mesh);

}  // namespace knead
