// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "mesh/raw_mesh.h"

namespace knead::tools {

/// How fine a mesh to make: a number of tetrahedra, an edge length, or (neither) what suits the shape.
struct MeshSize {
    std::optional<std::size_t> target_tetrahedra;
    std::optional<double> edge_length_m;
};

/// A mesh made by gmsh.
struct GeneratedMesh {
    RawMesh raw;                 ///< coordinates in the unit of the gmsh model
    double metres_per_unit = 1;  ///< of those coordinates
    double edge_length_m = 0;    ///< the one it was made with; 0: the surface's own triangles
    int meshings = 1;            ///< how many it took
};

// The rest is between the gmsh_*.cpp files.

/// Which nodes extract_mesh() takes: all, or those of the volumes (without the points a curve was drawn
/// through).
enum class ExtractNodes { all, of_volumes };

/// The mesh of gmsh's current model: nodes and tetrahedra in the order of their tags, physical volumes as
/// regions, element data as cell arrays, other cells counted.
[[nodiscard]] RawMesh extract_mesh(ExtractNodes which);

/// Meshes with the edge length asked for, or searches the one that gives the number of tetrahedra asked for.
/// Needs an open GmshSession.
/// @param build makes the geometry in an empty model; called before every meshing, so that no trial depends
/// on
///        the ones before it
[[nodiscard]] GeneratedMesh mesh_to_size(const std::function<void()>& build, const MeshSize& size,
                                         double metres_per_unit);

}  // namespace knead::tools
