// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "knead/formats/material.h"

namespace knead::tools {

/// Names of the cell arrays that a mesh with its own material carries (a VegaFEM import).
inline constexpr const char* kYoungsModulusArray = "youngs_modulus_pa";
inline constexpr const char* kPoissonsRatioArray = "poissons_ratio";
inline constexpr const char* kDensityArray = "density_kg_per_m3";

/// Values for what a source leaves open.
struct MaterialDefaults {
    double poissons_ratio = 0.3;
    double density_kg_per_m3 = 1000;
};

/// E, nu and density of one region.
struct RegionValues {
    std::string region;
    double youngs_modulus_pa = 0;
    double poissons_ratio = 0;
    double density_kg_per_m3 = 0;
};

/// Rows of a table: per tetrahedron E alone, or E, nu and density.
struct ValueTable {
    std::vector<double> youngs_modulus_pa;
    std::vector<double> poissons_ratio;     ///< empty: not in the table
    std::vector<double> density_kg_per_m3;  ///< empty: not in the table
};

/// The same values everywhere.
[[nodiscard]] Material uniform_material(const TetMesh& mesh, double youngs_modulus_pa,
                                        const MaterialDefaults& defaults);

/// Values by region. Every region of the mesh must be given exactly once; an unknown name is refused with the
/// nearest known one. @throws bad_input
[[nodiscard]] Material material_of_regions(const TetMesh& mesh, const std::vector<RegionValues>& values);

/// E from one cell array of the mesh. @throws bad_input when there is no such array
[[nodiscard]] Material material_of_array(const TetMesh& mesh, const std::string& name,
                                         const MaterialDefaults& defaults);

/// E from the array youngs_modulus_pa, nu and density from poissons_ratio and density_kg_per_m3 where they
/// are.
[[nodiscard]] Material material_of_mesh(const TetMesh& mesh, const MaterialDefaults& defaults);

/// Values by tetrahedron. @throws bad_input unless the table has exactly one row per tetrahedron
[[nodiscard]] Material material_of_table(const TetMesh& mesh, const ValueTable& table,
                                         const MaterialDefaults& defaults);

/// Gives all of the mesh the density with which it weighs `total_mass_kg`.
void set_total_mass(const TetMesh& mesh, double total_mass_kg, Material& material);

}  // namespace knead::tools
