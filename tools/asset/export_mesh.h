// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "knead/formats/asset.h"
#include "knead/formats/clustering.h"

namespace knead::tools {

/// One number per tetrahedron, with a name.
struct ExportField {
    std::string name;
    std::vector<double> values;
    bool whole_numbers = false;  ///< indices: written without a fraction, as integers
};

/// A mesh on its way to another program: geometry in metres and what is known of each tetrahedron.
struct ExportMesh {
    std::vector<Point> nodes_m;
    std::vector<Tetrahedron> tetrahedra;
    std::vector<std::string> region_names;             ///< may be empty
    std::vector<std::uint32_t> region_of_tetrahedron;  ///< [tetrahedra], or empty
    std::vector<ExportField> fields;
};

[[nodiscard]] ExportMesh export_mesh(const TetMesh& mesh);
[[nodiscard]] ExportMesh export_mesh(const MaterialObject& object);
[[nodiscard]] ExportMesh export_mesh(const ClusteredObject& object);
[[nodiscard]] ExportMesh export_mesh(const Asset& asset);

/// VTK's XML unstructured grid, ASCII.
[[nodiscard]] std::string vtu_text(const ExportMesh& mesh);
/// gmsh's format 2.2, ASCII: regions as physical volumes (1-based), fields as $ElementData.
[[nodiscard]] std::string msh_text(const ExportMesh& mesh);

}  // namespace knead::tools
