// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/clustering.h"

#include <cmath>

#include "failure.h"
#include "mesh_checks.h"
#include "offenders.h"

namespace knead {
namespace {

const std::string kGroup = "/knead/clustering";

template <class T>
void check_length(const std::vector<T>& values, std::size_t expected, const char* of,
                  const std::string& where) {
    if (values.size() != expected)
        fail(ErrorCode::invalid_data,
             std::to_string(values.size()) + " entries for " + std::to_string(expected) + " " + of, where);
}

void check_values(const std::vector<double>& values, bool (*is_valid)(double), const char* what,
                  const char* id_name, const std::string& where) {
    Offenders bad;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!is_valid(values[i])) bad.add(i);
    if (bad.any()) fail(ErrorCode::invalid_data, bad.text(values.size(), what, id_name), where);
}

/// Every entry of `index` is < count, and every number below count appears.
void check_partition(const std::vector<std::uint32_t>& index, std::size_t count, const char* element_name,
                     const char* part_name, const std::string& where) {
    std::vector<bool> used(count, false);
    Offenders outside, unused;
    for (std::size_t i = 0; i < index.size(); ++i) {
        if (index[i] < count)
            used[index[i]] = true;
        else
            outside.add(i);
    }
    if (outside.any())
        fail(ErrorCode::invalid_data,
             outside.text(index.size(), "entries are not below " + std::to_string(count), element_name),
             where);
    for (std::size_t i = 0; i < count; ++i)
        if (!used[i]) unused.add(i);
    if (unused.any()) fail(ErrorCode::invalid_data, unused.text(count, "are not used", part_name), where);
}

void check_bins(const Clustering& c) {
    const std::size_t bins = c.bin_youngs_modulus_pa.size();
    const std::string at = kGroup + "/bins";
    check_length(c.bin_poissons_ratio, bins, "bins", at + "/poissons_ratio");
    check_length(c.bin_density_kg_per_m3, bins, "bins", at + "/density_kg_per_m3");
    check_values(c.bin_youngs_modulus_pa, is_positive, kNotPositive, "bins", at + "/youngs_modulus_pa");
    check_values(c.bin_poissons_ratio, is_poissons_ratio, kNotPoissonsRatio, "bins", at + "/poissons_ratio");
    check_values(c.bin_density_kg_per_m3, is_positive, kNotPositive, "bins", at + "/density_kg_per_m3");
    Offenders bad;
    for (std::size_t i = 1; i < bins; ++i)
        if (!(c.bin_youngs_modulus_pa[i] > c.bin_youngs_modulus_pa[i - 1])) bad.add(i);
    if (bad.any())
        fail(ErrorCode::invalid_data, bad.text(bins, "bins are not stiffer than the one before", "bins"),
             at + "/youngs_modulus_pa");
}

void check_clusters(const Clustering& c) {
    const std::size_t clusters = c.bin_of_cluster.size();
    const std::string at = kGroup + "/clusters";
    check_length(c.cluster_barycentre_m, clusters, "clusters", at + "/barycentre_m");
    check_length(c.cluster_volume_m3, clusters, "clusters", at + "/volume_m3");
    check_values(c.cluster_volume_m3, is_positive, kNotPositive, "clusters", at + "/volume_m3");
    Offenders not_finite, falling;
    for (std::size_t i = 0; i < clusters; ++i) {
        const Point& p = c.cluster_barycentre_m[i];
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) not_finite.add(i);
        if (i > 0 && c.bin_of_cluster[i] < c.bin_of_cluster[i - 1]) falling.add(i);
    }
    if (not_finite.any())
        fail(ErrorCode::invalid_data, not_finite.text(clusters, "points are not finite", "clusters"),
             at + "/barycentre_m");
    if (falling.any())
        fail(ErrorCode::invalid_data,
             falling.text(clusters, "clusters stand before one of a softer bin", "clusters"),
             at + "/bin_of_cluster");
}

void check_agreement(const Clustering& c) {
    Offenders bad;
    for (std::size_t i = 0; i < c.bin_of_tetrahedron.size(); ++i)
        if (c.bin_of_cluster[c.cluster_of_tetrahedron[i]] != c.bin_of_tetrahedron[i]) bad.add(i);
    if (bad.any())
        fail(ErrorCode::invalid_data,
             bad.text(c.bin_of_tetrahedron.size(), "tetrahedra are in a cluster of another bin", "elements"),
             kGroup + "/cluster_of_tetrahedron");
}

}  // namespace

Status validate(const Clustering& clustering, std::size_t tetrahedron_count) {
    return guarded(kGroup, [&] {
        const Clustering& c = clustering;
        check_length(c.bin_of_tetrahedron, tetrahedron_count, "tetrahedra", kGroup + "/bin_of_tetrahedron");
        check_length(c.cluster_of_tetrahedron, tetrahedron_count, "tetrahedra",
                     kGroup + "/cluster_of_tetrahedron");
        check_bins(c);
        check_clusters(c);
        const std::size_t bins = c.bin_youngs_modulus_pa.size(), clusters = c.bin_of_cluster.size();
        check_partition(c.bin_of_tetrahedron, bins, "elements", "bins", kGroup + "/bin_of_tetrahedron");
        check_partition(c.cluster_of_tetrahedron, clusters, "elements", "clusters",
                        kGroup + "/cluster_of_tetrahedron");
        check_partition(c.bin_of_cluster, bins, "clusters", "bins", kGroup + "/clusters/bin_of_cluster");
        check_agreement(c);
        return Unit{};
    });
}

}  // namespace knead
