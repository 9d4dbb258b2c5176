// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "knead/formats/tet_mesh.h"
#include "mesh/notes.h"

namespace knead::tools {

/// A tetrahedral mesh as a file gives it: in the file's length unit, nothing checked yet. Readers make it,
/// to_tet_mesh() (mesh/repair.h) turns it into a valid TetMesh or refuses it.
struct RawMesh {
    std::vector<Point> nodes;                             ///< in the file's length unit
    std::vector<std::array<std::int64_t, 4>> tetrahedra;  ///< positions in `nodes`; may be out of range
    std::vector<std::int64_t> node_numbers;               ///< what the file calls each node, for messages
    std::vector<std::int64_t> tetrahedron_numbers;        ///< what the file calls each tetrahedron
    std::string numbering;                                ///< how to read them: "numbered from 0"
    Regions regions;                                      ///< may be empty
    std::vector<CellArray> cell_arrays;                   ///< of the tetrahedra only
    std::vector<std::pair<std::string, std::size_t>> other_cells;  ///< cells left out: type, how many
    Notes notes;                                                   ///< what the reader has to say
};

/// Position of what a file calls `number`, when it counts from `first`. -1, which no mesh has, for numbers in
/// front of the first: whatever a file says, nothing overflows.
[[nodiscard]] inline std::int64_t position_of(std::int64_t number, std::int64_t first) {
    return number < first ? -1 : number - first;
}

}  // namespace knead::tools
