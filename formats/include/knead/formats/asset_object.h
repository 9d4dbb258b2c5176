// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "knead/formats/asset.h"
#include "knead/formats/material.h"

namespace knead {

/// An asset's mesh and its elasticities one by one, in the asset's order of nodes and tetrahedra: what
/// solvers and exporters that know no palette take. Allocates. @param asset valid
inline MaterialObject object_of(const Asset& asset) {
    MaterialObject object;
    object.mesh.nodes_m = asset.nodes_m;
    object.mesh.tetrahedra = asset.tetrahedra;
    for (const std::uint32_t index : asset.palette_index) {
        const PaletteEntry& entry = asset.palette[index];
        object.material.youngs_modulus_pa.push_back(entry.youngs_modulus_pa);
        object.material.poissons_ratio.push_back(entry.poissons_ratio);
        object.material.density_kg_per_m3.push_back(entry.density_kg_per_m3);
    }
    return object;
}

}  // namespace knead
