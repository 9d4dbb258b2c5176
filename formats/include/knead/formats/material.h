// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead {

/// Isotropic linear elasticity and density of every tetrahedron.
///
/// On disk: group "/knead/material". Written by knead-material (raw), knead-aggregate and knead-coarsen
/// (few values, with the bin each came from).
///
/// Invariants: all arrays are as long as the mesh has tetrahedra (bin_of_tetrahedron may be empty);
/// youngs_modulus_pa finite and > 0; -1 < poissons_ratio < 0.5; density_kg_per_m3 finite and > 0;
/// tetrahedra of one bin have identical values.
struct Material {
    std::vector<double> youngs_modulus_pa;
    std::vector<double> poissons_ratio;
    std::vector<double> density_kg_per_m3;
    /// Elasticity bin that the tetrahedron's values come from; empty when the values are raw.
    std::vector<std::uint32_t> bin_of_tetrahedron;
};

/// A mesh with its material: what a "material" stage file holds.
struct MaterialObject {
    TetMesh mesh;
    Material material;
};

/// Checks every invariant above against a mesh of `tetrahedron_count` tetrahedra.
[[nodiscard]] Status validate(const Material& material, std::size_t tetrahedron_count);

}  // namespace knead
