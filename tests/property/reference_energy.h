// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "knead/formats/asset.h"
#include "knead/formats/material.h"
#include "reference/elastic_body.h"

namespace knead::test {

/// The elements of an asset as the reference solver has them, which shares no code with the runtime.
inline tools::ElasticBody reference_body(const Asset& asset) {
    TetMesh mesh;
    mesh.nodes_m = asset.nodes_m;
    mesh.tetrahedra = asset.tetrahedra;
    Material material;
    for (const std::uint32_t index : asset.palette_index) {
        material.youngs_modulus_pa.push_back(asset.palette[index].youngs_modulus_pa);
        material.poissons_ratio.push_back(asset.palette[index].poissons_ratio);
        material.density_kg_per_m3.push_back(asset.palette[index].density_kg_per_m3);
    }
    return {mesh, material};
}

/// @param positions_m [3 nodes]
inline double elastic_energy_j(const Asset& asset, const Eigen::VectorXd& positions_m) {
    return reference_body(asset).energy_j(positions_m);
}

}  // namespace knead::test
