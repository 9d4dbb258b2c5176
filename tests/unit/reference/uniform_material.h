// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "knead/formats/material.h"

namespace knead::test {

/// One material for every tetrahedron.
inline Material uniform_material(const TetMesh& mesh, double youngs_modulus_pa, double poissons_ratio = 0.3,
                                 double density_kg_per_m3 = 1000) {
    const std::size_t count = mesh.tetrahedra.size();
    Material material;
    material.youngs_modulus_pa.assign(count, youngs_modulus_pa);
    material.poissons_ratio.assign(count, poissons_ratio);
    material.density_kg_per_m3.assign(count, density_kg_per_m3);
    return material;
}

}  // namespace knead::test
