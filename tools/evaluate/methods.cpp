// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/methods.h"

#include <cmath>

#include "aggregate/aggregate.h"
#include "cluster/cluster.h"
#include "coarsen/coarsen.h"
#include "common/error.h"

namespace knead::tools {
namespace {

double volume_mean(const TetMesh& mesh, const std::vector<double>& values) {
    double sum = 0;
    double volume = 0;
    for (std::size_t t = 0; t < values.size(); ++t) {
        const double v = signed_volume_m3(mesh, t);
        sum += v * values[t];
        volume += v;
    }
    return sum / volume;
}

Material homogenised_material(const MaterialObject& fine, std::size_t tetrahedra) {
    const Material& material = fine.material;
    return {std::vector<double>(tetrahedra, volume_mean(fine.mesh, material.youngs_modulus_pa)),
            std::vector<double>(tetrahedra, volume_mean(fine.mesh, material.poissons_ratio)),
            std::vector<double>(tetrahedra, volume_mean(fine.mesh, material.density_kg_per_m3)),
            {}};
}

/// Sum over the fine tetrahedra in each coarse one of volume * f(E), and of the volume.
struct Sums {
    double value = 0;
    double volume_m3 = 0;
};

template <class Function>
Sums sum_over_row(const OverlapMatrix& overlap, std::size_t row, const std::vector<double>& moduli,
                  const Function& function) {
    Sums sums;
    for (std::uint64_t k = overlap.row_offsets[row]; k < overlap.row_offsets[row + 1]; ++k) {
        sums.value += overlap.volumes_m3[k] * function(moduli[overlap.columns[k]]);
        sums.volume_m3 += overlap.volumes_m3[k];
    }
    return sums;
}

double reuss_pa(const OverlapMatrix& overlap, std::size_t row, const std::vector<double>& moduli) {
    const Sums sums = sum_over_row(overlap, row, moduli, [](double e) { return 1 / e; });
    return sums.volume_m3 / sums.value;
}

double geometric_pa(const OverlapMatrix& overlap, std::size_t row, const std::vector<double>& moduli) {
    const Sums sums = sum_over_row(overlap, row, moduli, [](double e) { return std::log(e); });
    return std::exp(sums.value / sums.volume_m3);
}

}  // namespace

const std::vector<std::string>& method_names() {
    static const std::vector<std::string> names{"homogenised", "paper",     "raw-dominant", "voigt",
                                                "reuss",       "geometric", "hill",         "kmod09",
                                                "iycn13",      "calibrated"};
    return names;
}

const std::string& name_of(MethodKind kind) {
    return method_names().at(static_cast<std::size_t>(kind));
}

std::string Method::text() const {
    if (kind != MethodKind::paper) return name_of(kind);
    return name_of(kind) + " " + std::to_string(bins) + "x" + std::to_string(clusters);
}

Material mean_material(MethodKind kind, const MaterialObject& fine, const LevelMesh& level) {
    if (level.is_fine) return fine.material;
    Material material = coarsen(fine, level.mesh, level.overlap, CoarsenRule::volume_average).material;
    if (kind == MethodKind::voigt) return material;
    const OverlapMatrix& overlap = level.overlap;
    const std::vector<double>& moduli = fine.material.youngs_modulus_pa;
    for (std::size_t row = 0; row < material.youngs_modulus_pa.size(); ++row) {
        if (overlap.row_offsets[row] == overlap.row_offsets[row + 1]) continue;  // the nearest one's value
        double& modulus = material.youngs_modulus_pa[row];
        if (kind == MethodKind::geometric) modulus = geometric_pa(overlap, row, moduli);
        if (kind == MethodKind::reuss) modulus = reuss_pa(overlap, row, moduli);
        if (kind == MethodKind::hill) modulus = (modulus + reuss_pa(overlap, row, moduli)) / 2;
    }
    return material;
}

Material aggregated_material(const MaterialObject& fine, std::uint32_t bins, std::uint32_t clusters,
                             std::uint64_t seed) {
    ClusterOptions options;
    options.bins = bins;
    options.clusters = clusters;
    options.seed = seed;
    const ClusterResult clustered = cluster_object(fine.mesh, fine.material, options);
    return aggregate({fine.mesh, fine.material, clustered.clustering}, {}).material;
}

Material simple_material(const Method& method, const MaterialObject& fine, const LevelMesh& level,
                         std::uint64_t seed) {
    switch (method.kind) {
        case MethodKind::homogenised:
            return homogenised_material(fine, level.mesh.tetrahedra.size());
        case MethodKind::paper: {
            MaterialObject aggregated{fine.mesh,
                                      aggregated_material(fine, method.bins, method.clusters, seed)};
            if (level.is_fine) return std::move(aggregated.material);
            return coarsen(aggregated, level.mesh, level.overlap, CoarsenRule::dominant).material;
        }
        case MethodKind::raw_dominant:
            if (level.is_fine) return fine.material;
            return coarsen(fine, level.mesh, level.overlap, CoarsenRule::dominant).material;
        case MethodKind::voigt:
        case MethodKind::reuss:
        case MethodKind::geometric:
        case MethodKind::hill:
            return mean_material(method.kind, fine, level);
        default:
            fail_usage(method.text() + " is not a simple method");
    }
}

}  // namespace knead::tools
