// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "knead/formats/tet_mesh.h"
#include "mesh/notes.h"
#include "mesh/raw_mesh.h"

namespace knead::tools {

/// A tetrahedron counts as flat when its volume is at most this share of the cube of its longest edge. Far
/// above the rounding of coordinates stored as doubles, far below any tetrahedron that can be simulated; free
/// of scale.
inline constexpr double kFlatVolumeRatio = 1e-9;

struct RepairOptions {
    double metres_per_unit = 1;
    bool merge_duplicate_nodes = false;  ///< join nodes at exactly the same place instead of refusing them
    bool repair_orientation = false;     ///< turn inverted tetrahedra round even when only some are inverted
};

struct RepairedMesh {
    TetMesh mesh;
    Notes notes;
};

/// Checks a mesh from a file and makes it a valid one, in metres.
///
/// Repaired and told: all tetrahedra inverted (the file's convention), unused nodes (dropped), cells that are
/// no tetrahedra (left out); with the options: some tetrahedra inverted, nodes at the same place. Refused
/// (ToolError bad_input, with count and first numbers as the file has them): no tetrahedron, coordinates that
/// are not finite, node numbers out of range, a node twice in a tetrahedron, flat tetrahedra, the same
/// tetrahedron twice, and what the options would repair.
/// The order of nodes and tetrahedra is kept.
[[nodiscard]] RepairedMesh to_tet_mesh(RawMesh raw, const RepairOptions& options);

/// Notes about a valid mesh that its user should hear: an unlikely size, several bodies, slivers.
[[nodiscard]] Notes remarks(const TetMesh& mesh, const struct MeshQuality& quality);

}  // namespace knead::tools
