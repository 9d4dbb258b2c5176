// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "mesh/gmsh_mesher.h"
#include "mesh/repair.h"
#include "mesh/veg.h"

namespace knead::tools {

/// How to import a file.
struct ImportRequest {
    std::string extension;                  ///< of the file's name, with the dot; must fit the content
    std::optional<double> metres_per_unit;  ///< of its coordinates; needed by all formats but STEP
    MeshSize size;                          ///< for solids and surfaces only
    bool merge_duplicate_nodes = false;     ///< for meshes only, like the next
    bool repair_orientation = false;
    IncludeReader include;  ///< reads the files that a .veg includes
};

/// A mesh and what there is to say about it.
struct MadeMesh {
    TetMesh mesh;
    Notes notes;
    std::string source;        ///< "a STEP file", "a sphere": what it was made of
    double edge_length_m = 0;  ///< 0: not made with one
    int meshings = 0;
};

/// Recognises the content, checks it, and reads or meshes it.
/// Errors: bad_usage when the unit is missing or an option does not fit the format, bad_input,
/// no_valid_result.
[[nodiscard]] MadeMesh import_mesh(std::string_view content, const ImportRequest& request);

/// What gmsh made of a geometry of ours, checked like any other mesh.
[[nodiscard]] MadeMesh finish(GeneratedMesh generated, const std::string& source);

}  // namespace knead::tools
