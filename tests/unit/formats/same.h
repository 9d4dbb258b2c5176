// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "knead/formats/read.h"

/// Field by field equality, written out here because the types themselves need none.
namespace knead::test {

inline bool same(const TetMesh& a, const TetMesh& b) {
    if (a.cell_arrays.size() != b.cell_arrays.size()) return false;
    for (std::size_t i = 0; i < a.cell_arrays.size(); ++i)
        if (a.cell_arrays[i].name != b.cell_arrays[i].name ||
            a.cell_arrays[i].values != b.cell_arrays[i].values)
            return false;
    return a.nodes_m == b.nodes_m && a.tetrahedra == b.tetrahedra && a.regions.names == b.regions.names &&
           a.regions.region_of_tetrahedron == b.regions.region_of_tetrahedron;
}

inline bool same(const MaterialObject& a, const MaterialObject& b) {
    return same(a.mesh, b.mesh) && a.material.youngs_modulus_pa == b.material.youngs_modulus_pa &&
           a.material.poissons_ratio == b.material.poissons_ratio &&
           a.material.density_kg_per_m3 == b.material.density_kg_per_m3 &&
           a.material.bin_of_tetrahedron == b.material.bin_of_tetrahedron;
}

inline bool same(const ClusteredObject& a, const ClusteredObject& b) {
    const Clustering &c = a.clustering, &d = b.clustering;
    return same(MaterialObject{a.mesh, a.material}, MaterialObject{b.mesh, b.material}) &&
           c.bin_of_tetrahedron == d.bin_of_tetrahedron &&
           c.cluster_of_tetrahedron == d.cluster_of_tetrahedron &&
           c.bin_youngs_modulus_pa == d.bin_youngs_modulus_pa &&
           c.bin_poissons_ratio == d.bin_poissons_ratio &&
           c.bin_density_kg_per_m3 == d.bin_density_kg_per_m3 && c.bin_of_cluster == d.bin_of_cluster &&
           c.cluster_barycentre_m == d.cluster_barycentre_m && c.cluster_volume_m3 == d.cluster_volume_m3;
}

inline bool same(const OverlapMatrix& a, const OverlapMatrix& b) {
    return a.coarse_count == b.coarse_count && a.fine_count == b.fine_count &&
           a.row_offsets == b.row_offsets && a.columns == b.columns && a.volumes_m3 == b.volumes_m3;
}

inline bool same(const ToolSet& a, const ToolSet& b) {
    return a.name == b.name && a.shape == b.shape && a.contact == b.contact && a.radius_m == b.radius_m &&
           a.half_length_m == b.half_length_m && a.friction_coefficient == b.friction_coefficient &&
           a.half_extents_m == b.half_extents_m && a.rest_position_m == b.rest_position_m &&
           a.rest_orientation_wxyz == b.rest_orientation_wxyz && a.nodes == b.nodes;
}

inline bool same(const Asset& a, const Asset& b) {
    if (a.palette.size() != b.palette.size() || a.tools.size() != b.tools.size() ||
        a.requests.size() != b.requests.size())
        return false;
    for (std::size_t i = 0; i < a.palette.size(); ++i)
        if (a.palette[i].youngs_modulus_pa != b.palette[i].youngs_modulus_pa ||
            a.palette[i].poissons_ratio != b.palette[i].poissons_ratio ||
            a.palette[i].density_kg_per_m3 != b.palette[i].density_kg_per_m3)
            return false;
    for (std::size_t i = 0; i < a.tools.size(); ++i)
        if (!same(a.tools[i], b.tools[i])) return false;
    for (std::size_t i = 0; i < a.requests.size(); ++i)
        if (a.requests[i].group != b.requests[i].group ||
            a.requests[i].scene_key != b.requests[i].scene_key ||
            a.requests[i].scene_line != b.requests[i].scene_line)
            return false;
    return a.name == b.name && a.level == b.level && a.nodes_m == b.nodes_m &&
           a.free_node_count == b.free_node_count && a.tetrahedra == b.tetrahedra &&
           a.palette_index == b.palette_index && a.gravity_m_per_s2 == b.gravity_m_per_s2 &&
           a.damping_per_s == b.damping_per_s && a.surface.triangles == b.surface.triangles &&
           a.embedding.tetrahedron == b.embedding.tetrahedron && a.embedding.weights == b.embedding.weights &&
           a.embedding.still_vertices_m == b.embedding.still_vertices_m &&
           a.embedding.triangles == b.embedding.triangles;
}

inline bool same(const Provenance& a, const Provenance& b) {
    return a.tool == b.tool && a.tool_version == b.tool_version && a.arguments == b.arguments &&
           a.seed == b.seed && a.inputs == b.inputs;
}

}  // namespace knead::test
