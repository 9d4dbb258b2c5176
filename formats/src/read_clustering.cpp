// SPDX-License-Identifier: Apache-2.0
#include "read_kind.h"

namespace knead {
namespace {

const std::string kClustering = "/knead/clustering";
const std::string kBins = kClustering + "/bins";
const std::string kClusters = kClustering + "/clusters";

}  // namespace

void check_clustering_shape(Schema& schema, std::uint64_t tetrahedra) {
    schema.group(kClustering);
    schema.dataset(kClustering + "/bin_of_tetrahedron", ScalarType::u32, {tetrahedra}, "1");
    schema.dataset(kClustering + "/cluster_of_tetrahedron", ScalarType::u32, {tetrahedra}, "1");
    schema.group(kBins);
    const std::uint64_t bins =
        schema.dataset(kBins + "/youngs_modulus_pa", ScalarType::f64, {kAnyExtent}, "Pa");
    schema.limit(bins, tetrahedra, "bins", kBins);
    schema.dataset(kBins + "/poissons_ratio", ScalarType::f64, {bins}, "1");
    schema.dataset(kBins + "/density_kg_per_m3", ScalarType::f64, {bins}, "kg/m^3");
    schema.group(kClusters);
    const std::uint64_t clusters =
        schema.dataset(kClusters + "/bin_of_cluster", ScalarType::u32, {kAnyExtent}, "1");
    schema.limit(clusters, tetrahedra, "clusters", kClusters);
    schema.dataset(kClusters + "/barycentre_m", ScalarType::f64, {clusters, 3}, "m");
    schema.dataset(kClusters + "/volume_m3", ScalarType::f64, {clusters}, "m^3");
}

Clustering take_clustering(Schema& schema) {
    Clustering c;
    c.bin_of_tetrahedron = schema.take<std::uint32_t>(kClustering + "/bin_of_tetrahedron");
    c.cluster_of_tetrahedron = schema.take<std::uint32_t>(kClustering + "/cluster_of_tetrahedron");
    c.bin_youngs_modulus_pa = schema.take<double>(kBins + "/youngs_modulus_pa");
    c.bin_poissons_ratio = schema.take<double>(kBins + "/poissons_ratio");
    c.bin_density_kg_per_m3 = schema.take<double>(kBins + "/density_kg_per_m3");
    c.bin_of_cluster = schema.take<std::uint32_t>(kClusters + "/bin_of_cluster");
    c.cluster_barycentre_m = schema.take<Point>(kClusters + "/barycentre_m");
    c.cluster_volume_m3 = schema.take<double>(kClusters + "/volume_m3");
    return c;
}

template <>
Result<Stored<ClusteredObject>> read_stored<ClusteredObject>(const std::filesystem::path& file,
                                                             const ReadLimits& limits) {
    return read_kind<ClusteredObject>(file, limits, {FileKind::clustering}, [](Schema& schema) {
        ClusteredObject object{take_tet_mesh(schema), take_material(schema), take_clustering(schema)};
        value_or_fail(validate(object.mesh));
        value_or_fail(validate(object.material, object.mesh.tetrahedra.size()));
        value_or_fail(validate(object.clustering, object.mesh.tetrahedra.size()));
        return object;
    });
}

Result<ClusteredObject> read_clustering(const std::filesystem::path& file, const ReadLimits& limits) {
    return value_of(read_stored<ClusteredObject>(file, limits));
}

}  // namespace knead
