// SPDX-License-Identifier: GPL-3.0-or-later
#include "cluster/cluster.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cluster/kmeans.h"
#include "common/error.h"

namespace knead::tools {
namespace {

/// The tetrahedra of every bin, in increasing order.
std::vector<std::vector<std::uint32_t>> members_of_bins(const std::vector<std::uint32_t>& bin_of) {
    std::vector<std::vector<std::uint32_t>> members(1 + *std::max_element(bin_of.begin(), bin_of.end()));
    for (std::uint32_t tetrahedron = 0; tetrahedron < bin_of.size(); ++tetrahedron)
        members[bin_of[tetrahedron]].push_back(tetrahedron);
    return members;
}

/// Volume-weighted mean, kept inside the range of its values: rounding must not make two bins overlap.
double mean_value(const std::vector<std::uint32_t>& members, const std::vector<double>& volume_m3,
                  const std::vector<double>& values) {
    double weighted = 0;
    double volume = 0;
    double low = values[members[0]];
    double high = low;
    for (const std::uint32_t tetrahedron : members) {
        weighted += volume_m3[tetrahedron] * values[tetrahedron];
        volume += volume_m3[tetrahedron];
        low = std::min(low, values[tetrahedron]);
        high = std::max(high, values[tetrahedron]);
    }
    return std::clamp(weighted / volume, low, high);
}

std::vector<KmeansResult> cluster_bins(const TetMesh& mesh,
                                       const std::vector<std::vector<std::uint32_t>>& members,
                                       const ClusterOptions& options) {
    std::vector<KmeansResult> results(members.size());
    tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t bin) {
        std::vector<Point> points(members[bin].size());
        for (std::size_t i = 0; i < points.size(); ++i)
            points[i] = barycentre_m(mesh, members[bin][i]);
        KmeansOptions kmeans_options;
        kmeans_options.clusters = options.clusters;
        kmeans_options.restarts = options.restarts;
        kmeans_options.seed = options.seed + bin;
        results[bin] = kmeans(points, kmeans_options);
    });
    return results;
}

/// Adds the clusters of one bin behind those of the softer bins.
void append_clusters(const TetMesh& mesh, const std::vector<double>& volume_m3, std::uint32_t bin,
                     const std::vector<std::uint32_t>& members, const KmeansResult& kmeans_result,
                     Clustering& clustering) {
    const auto first = static_cast<std::uint32_t>(clustering.bin_of_cluster.size());
    const std::size_t total = first + kmeans_result.centres_m.size();
    clustering.bin_of_cluster.resize(total, bin);
    clustering.cluster_volume_m3.resize(total, 0.0);
    clustering.cluster_barycentre_m.resize(total, Point{});
    for (std::size_t i = 0; i < members.size(); ++i) {
        const std::uint32_t cluster = first + kmeans_result.cluster_of_point[i];
        const Point barycentre = barycentre_m(mesh, members[i]);
        const double volume = volume_m3[members[i]];
        clustering.cluster_of_tetrahedron[members[i]] = cluster;
        clustering.cluster_volume_m3[cluster] += volume;
        for (int axis = 0; axis < 3; ++axis)
            clustering.cluster_barycentre_m[cluster][axis] += volume * barycentre[axis];
    }
    for (std::size_t cluster = first; cluster < total; ++cluster)
        for (double& coordinate : clustering.cluster_barycentre_m[cluster])
            coordinate /= clustering.cluster_volume_m3[cluster];
}

BinReport report_of(const std::vector<std::uint32_t>& members, const std::vector<double>& volume_m3,
                    const std::vector<double>& youngs_modulus_pa, const KmeansResult& kmeans_result) {
    BinReport report;
    report.tetrahedra = static_cast<std::uint32_t>(members.size());
    report.clusters = static_cast<std::uint32_t>(kmeans_result.centres_m.size());
    report.iterations = static_cast<std::uint32_t>(kmeans_result.inertia_history_m2.size());
    report.converged = kmeans_result.converged;
    report.inertia_m2 = kmeans_result.inertia_m2;
    report.lowest_youngs_modulus_pa = report.highest_youngs_modulus_pa = youngs_modulus_pa[members[0]];
    for (const std::uint32_t tetrahedron : members) {
        report.volume_m3 += volume_m3[tetrahedron];
        report.lowest_youngs_modulus_pa =
            std::min(report.lowest_youngs_modulus_pa, youngs_modulus_pa[tetrahedron]);
        report.highest_youngs_modulus_pa =
            std::max(report.highest_youngs_modulus_pa, youngs_modulus_pa[tetrahedron]);
    }
    return report;
}

}  // namespace

ClusterResult cluster_object(const TetMesh& mesh, const Material& material, const ClusterOptions& options) {
    if (options.clusters == 0) fail_usage("the number of clusters must be at least 1");
    if (options.restarts == 0) fail_usage("the number of restarts must be at least 1");
    ClusterResult result;
    Clustering& clustering = result.clustering;
    clustering.bin_of_tetrahedron = bin_values(material.youngs_modulus_pa, options.bins, options.binning);
    clustering.cluster_of_tetrahedron.resize(mesh.tetrahedra.size());
    std::vector<double> volume_m3(mesh.tetrahedra.size());
    for (std::size_t i = 0; i < volume_m3.size(); ++i)
        volume_m3[i] = signed_volume_m3(mesh, i);

    const auto members = members_of_bins(clustering.bin_of_tetrahedron);
    const auto kmeans_results = cluster_bins(mesh, members, options);
    for (std::uint32_t bin = 0; bin < members.size(); ++bin) {
        clustering.bin_youngs_modulus_pa.push_back(
            mean_value(members[bin], volume_m3, material.youngs_modulus_pa));
        clustering.bin_poissons_ratio.push_back(mean_value(members[bin], volume_m3, material.poissons_ratio));
        clustering.bin_density_kg_per_m3.push_back(
            mean_value(members[bin], volume_m3, material.density_kg_per_m3));
        append_clusters(mesh, volume_m3, bin, members[bin], kmeans_results[bin], clustering);
        result.bins.push_back(
            report_of(members[bin], volume_m3, material.youngs_modulus_pa, kmeans_results[bin]));
    }
    return result;
}

}  // namespace knead::tools
