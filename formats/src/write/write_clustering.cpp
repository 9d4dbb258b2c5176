// SPDX-License-Identifier: Apache-2.0
#include "encode.h"

namespace knead {
namespace {

void encode_clustering(FilePlan& plan, const Clustering& c) {
    const std::string group = "/knead/clustering", bins = group + "/bins", clusters = group + "/clusters";
    Payload& payload = plan.payload;
    payload.add_group(group);
    payload.add_dataset(group + "/bin_of_tetrahedron", view_1d(c.bin_of_tetrahedron), "1");
    payload.add_dataset(group + "/cluster_of_tetrahedron", view_1d(c.cluster_of_tetrahedron), "1");
    payload.add_group(bins);
    payload.add_dataset(bins + "/youngs_modulus_pa", view_1d(c.bin_youngs_modulus_pa), "Pa");
    payload.add_dataset(bins + "/poissons_ratio", view_1d(c.bin_poissons_ratio), "1");
    payload.add_dataset(bins + "/density_kg_per_m3", view_1d(c.bin_density_kg_per_m3), "kg/m^3");
    payload.add_group(clusters);
    payload.add_dataset(clusters + "/bin_of_cluster", view_1d(c.bin_of_cluster), "1");
    payload.add_dataset(clusters + "/barycentre_m", view_2d(c.cluster_barycentre_m), "m");
    payload.add_dataset(clusters + "/volume_m3", view_1d(c.cluster_volume_m3), "m^3");
    plan.vtk->cell_data.push_back({"bin", group + "/bin_of_tetrahedron"});
    plan.vtk->cell_data.push_back({"cluster", group + "/cluster_of_tetrahedron"});
}

}  // namespace

Status write_clustering(const std::filesystem::path& file, const ClusteredObject& object,
                        const Provenance& provenance) {
    return write_kind(file, FileKind::clustering, provenance, [&](FilePlan& plan) {
        value_or_fail(validate(object.mesh));
        value_or_fail(validate(object.material, object.mesh.tetrahedra.size()));
        value_or_fail(validate(object.clustering, object.mesh.tetrahedra.size()));
        encode_mesh(plan, object.mesh);
        encode_material(plan, object.material, "material_bin");
        encode_clustering(plan, object.clustering);
    });
}

}  // namespace knead
