// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "knead/formats/material.h"

namespace knead {

/// Elasticity bins and the spatial clusters inside each bin (paper section 3.2, "Initialization"), with the
/// homogenised values of each bin (paper section 3.2, "Homogenization").
///
/// Index meanings: bin 0 is the softest; clusters are numbered bin by bin. On disk: "/knead/clustering".
///
/// Invariants: bin_of_tetrahedron and cluster_of_tetrahedron are as long as the mesh; every bin and every
/// cluster is used; bin_of_cluster never decreases and agrees with bin_of_tetrahedron; volumes > 0;
/// bin moduli strictly increase with the bin index.
struct Clustering {
    std::vector<std::uint32_t> bin_of_tetrahedron;      ///< [tetrahedra] < bins
    std::vector<std::uint32_t> cluster_of_tetrahedron;  ///< [tetrahedra] < clusters

    std::vector<double> bin_youngs_modulus_pa;  ///< [bins] volume-weighted mean
    std::vector<double> bin_poissons_ratio;     ///< [bins] volume-weighted mean
    std::vector<double> bin_density_kg_per_m3;  ///< [bins] volume-weighted mean

    std::vector<std::uint32_t> bin_of_cluster;  ///< [clusters]
    std::vector<Point> cluster_barycentre_m;    ///< [clusters] volume-weighted centre of its tetrahedra
    std::vector<double> cluster_volume_m3;      ///< [clusters]
};

/// A mesh, its raw material and the clustering of it: what a "clustering" stage file holds.
struct ClusteredObject {
    TetMesh mesh;
    Material material;
    Clustering clustering;
};

/// Checks every invariant above against a mesh of `tetrahedron_count` tetrahedra.
[[nodiscard]] Status validate(const Clustering& clustering, std::size_t tetrahedron_count);

}  // namespace knead
