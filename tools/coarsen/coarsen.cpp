// SPDX-License-Identifier: GPL-3.0-or-later
#include "coarsen/coarsen.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>

#include "coarsen/nearest.h"
#include "common/error.h"

namespace knead::tools {
namespace {

/// An overlap computed from these meshes exceeds a volume by rounding only.
constexpr double kExcessTolerance = 1e-6;
/// A tetrahedron that misses more of its volume than this is reported.
constexpr double kMissing = 0.01;
/// Volumes within this share of the covered volume count as equal: ties are common on regular meshes, and
/// rounding must not decide them.
constexpr double kTie = 1e-9;

void require_counts(const char* which, std::size_t in_mesh, std::size_t in_overlap) {
    if (in_mesh != in_overlap)
        fail_input("the overlap is of other meshes: it knows " + std::to_string(in_overlap) + " " + which +
                   " tetrahedra, the " + which + " mesh has " + std::to_string(in_mesh));
}

std::vector<double> volumes_of(const TetMesh& mesh) {
    std::vector<double> volumes(mesh.tetrahedra.size());
    for (std::size_t i = 0; i < volumes.size(); ++i)
        volumes[i] = signed_volume_m3(mesh, i);
    return volumes;
}

void require_not_exceeded(const char* which, const std::vector<double>& volume_m3,
                          const std::vector<double>& covered_m3) {
    std::size_t count = 0;
    std::string ids;
    for (std::size_t i = 0; i < volume_m3.size(); ++i) {
        if (covered_m3[i] <= volume_m3[i] * (1.0 + kExcessTolerance)) continue;
        if (++count <= 3) ids += (ids.empty() ? "" : ", ") + std::to_string(i);
    }
    if (count > 0)
        fail_input("the overlap is of other meshes, or a mesh overlaps itself: it gives " +
                   std::to_string(count) + " of " + std::to_string(volume_m3.size()) + " " + which +
                   " tetrahedra more volume than they have (counted from 0: " + ids +
                   (count > 3 ? ", ...)" : ")"));
}

std::vector<std::uint32_t> missing_of(const std::vector<double>& volume_m3,
                                      const std::vector<double>& covered_m3) {
    std::vector<std::uint32_t> missing;
    for (std::uint32_t i = 0; i < volume_m3.size(); ++i)
        if (covered_m3[i] < volume_m3[i] * (1.0 - kMissing)) missing.push_back(i);
    return missing;
}

double total(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

CoveredShares check_coverage(const TetMesh& fine, const TetMesh& coarse, const OverlapMatrix& overlap) {
    const std::vector<double> fine_volume = volumes_of(fine);
    const std::vector<double> coarse_volume = volumes_of(coarse);
    std::vector<double> fine_covered(fine_volume.size(), 0.0);
    std::vector<double> coarse_covered(coarse_volume.size(), 0.0);
    CoveredShares coverage;
    for (std::uint32_t row = 0; row < overlap.coarse_count; ++row) {
        for (std::uint64_t entry = overlap.row_offsets[row]; entry < overlap.row_offsets[row + 1]; ++entry) {
            coarse_covered[row] += overlap.volumes_m3[entry];
            fine_covered[overlap.columns[entry]] += overlap.volumes_m3[entry];
        }
        if (overlap.row_offsets[row] == overlap.row_offsets[row + 1])
            coverage.coarse_uncovered.push_back(row);
    }
    require_not_exceeded("coarse", coarse_volume, coarse_covered);
    require_not_exceeded("fine", fine_volume, fine_covered);
    coverage.coarse_share = total(coarse_covered) / total(coarse_volume);
    coverage.fine_share = total(fine_covered) / total(fine_volume);
    coverage.coarse_missing = missing_of(coarse_volume, coarse_covered);
    coverage.fine_missing = missing_of(fine_volume, fine_covered);
    return coverage;
}

/// Fine tetrahedra with the same values, softest group first.
struct Groups {
    std::vector<std::uint32_t> group_of;  ///< [fine tetrahedra]
    std::vector<std::uint32_t> example;   ///< [groups] one tetrahedron of each
};

std::tuple<double, double, double> values_of(const Material& material, std::uint32_t tetrahedron) {
    return {material.youngs_modulus_pa[tetrahedron], material.poissons_ratio[tetrahedron],
            material.density_kg_per_m3[tetrahedron]};
}

/// Groups by bin id where there are bins, by identical values otherwise.
Groups group(const Material& material) {
    const std::size_t count = material.youngs_modulus_pa.size();
    const bool binned = !material.bin_of_tetrahedron.empty();
    const auto bin_of = [&](std::uint32_t t) { return binned ? material.bin_of_tetrahedron[t] : 0U; };
    const auto key = [&](std::uint32_t t) { return std::tuple(values_of(material, t), bin_of(t)); };
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tuple(key(a), a) < std::tuple(key(b), b);
    });
    Groups groups;
    groups.group_of.resize(count);
    for (const std::uint32_t tetrahedron : order) {
        if (groups.example.empty() || key(groups.example.back()) != key(tetrahedron))
            groups.example.push_back(tetrahedron);
        groups.group_of[tetrahedron] = static_cast<std::uint32_t>(groups.example.size() - 1);
    }
    return groups;
}

/// Volumes of the groups in one coarse tetrahedron; remembers which it touched, so that clearing is cheap.
class GroupVolumes {
  public:
    explicit GroupVolumes(std::size_t groups) : volume_m3_(groups, 0.0) {}

    void add(std::uint32_t group, double volume_m3) {
        if (volume_m3_[group] == 0.0) touched_.push_back(group);
        volume_m3_[group] += volume_m3;
        covered_m3_ += volume_m3;
    }

    /// The group with most volume, ties: the stiffest. Empties this. Precondition: something was added.
    std::uint32_t take_dominant() {
        double largest = 0;
        for (const std::uint32_t group : touched_)
            largest = std::max(largest, volume_m3_[group]);
        std::uint32_t dominant = 0;
        for (const std::uint32_t group : touched_) {
            if (volume_m3_[group] >= largest - kTie * covered_m3_) dominant = std::max(dominant, group);
            volume_m3_[group] = 0.0;
        }
        touched_.clear();
        covered_m3_ = 0;
        return dominant;
    }

  private:
    std::vector<double> volume_m3_;       ///< [groups]
    std::vector<std::uint32_t> touched_;  ///< groups with volume
    double covered_m3_ = 0;
};

/// For every coarse tetrahedron, the fine one whose values it takes; nothing where there is no overlap.
std::vector<std::optional<std::uint32_t>> dominant_sources(const Material& fine,
                                                           const OverlapMatrix& overlap) {
    const Groups groups = group(fine);
    GroupVolumes volumes(groups.example.size());
    std::vector<std::optional<std::uint32_t>> sources(overlap.coarse_count);
    for (std::uint32_t row = 0; row < overlap.coarse_count; ++row) {
        if (overlap.row_offsets[row] == overlap.row_offsets[row + 1]) continue;
        for (std::uint64_t entry = overlap.row_offsets[row]; entry < overlap.row_offsets[row + 1]; ++entry)
            volumes.add(groups.group_of[overlap.columns[entry]], overlap.volumes_m3[entry]);
        sources[row] = groups.example[volumes.take_dominant()];
    }
    return sources;
}

void take_values(const Material& fine, std::uint32_t source, std::uint32_t row, Material& coarse) {
    coarse.youngs_modulus_pa[row] = fine.youngs_modulus_pa[source];
    coarse.poissons_ratio[row] = fine.poissons_ratio[source];
    coarse.density_kg_per_m3[row] = fine.density_kg_per_m3[source];
    if (!coarse.bin_of_tetrahedron.empty()) coarse.bin_of_tetrahedron[row] = fine.bin_of_tetrahedron[source];
}

/// Mean over the covered volume of a coarse tetrahedron, kept inside the range of its values: the mean of
/// equal values is that value, whatever the rounding.
double row_mean(const OverlapMatrix& overlap, std::uint32_t row, const std::vector<double>& fine_values) {
    double weighted = 0;
    double covered = 0;
    double low = fine_values[overlap.columns[overlap.row_offsets[row]]];
    double high = low;
    for (std::uint64_t entry = overlap.row_offsets[row]; entry < overlap.row_offsets[row + 1]; ++entry) {
        const double value = fine_values[overlap.columns[entry]];
        weighted += overlap.volumes_m3[entry] * value;
        covered += overlap.volumes_m3[entry];
        low = std::min(low, value);
        high = std::max(high, value);
    }
    return std::clamp(weighted / covered, low, high);
}

void average(const Material& fine, const OverlapMatrix& overlap, Material& coarse) {
    for (std::uint32_t row = 0; row < overlap.coarse_count; ++row) {
        if (overlap.row_offsets[row] == overlap.row_offsets[row + 1]) continue;
        coarse.youngs_modulus_pa[row] = row_mean(overlap, row, fine.youngs_modulus_pa);
        coarse.poissons_ratio[row] = row_mean(overlap, row, fine.poissons_ratio);
        coarse.density_kg_per_m3[row] = row_mean(overlap, row, fine.density_kg_per_m3);
    }
}

void fill_uncovered(const MaterialObject& fine, const TetMesh& coarse,
                    const std::vector<std::uint32_t>& uncovered, Material& material) {
    if (uncovered.empty()) return;
    const NearestBarycentre nearest(fine.mesh);
    for (const std::uint32_t row : uncovered)
        take_values(fine.material, nearest(barycentre_m(coarse, row)), row, material);
}

}  // namespace

CoarsenResult coarsen(const MaterialObject& fine, const TetMesh& coarse, const OverlapMatrix& overlap,
                      CoarsenRule rule) {
    require_counts("fine", fine.mesh.tetrahedra.size(), overlap.fine_count);
    require_counts("coarse", coarse.tetrahedra.size(), overlap.coarse_count);
    CoarsenResult result;
    result.coverage = check_coverage(fine.mesh, coarse, overlap);
    Material& material = result.material;
    material.youngs_modulus_pa.resize(overlap.coarse_count);
    material.poissons_ratio.resize(overlap.coarse_count);
    material.density_kg_per_m3.resize(overlap.coarse_count);
    if (rule == CoarsenRule::volume_average) {
        average(fine.material, overlap, material);
    } else {
        if (!fine.material.bin_of_tetrahedron.empty())
            material.bin_of_tetrahedron.resize(overlap.coarse_count);
        const auto sources = dominant_sources(fine.material, overlap);
        for (std::uint32_t row = 0; row < overlap.coarse_count; ++row)
            if (sources[row]) take_values(fine.material, *sources[row], row, material);
    }
    fill_uncovered(fine, coarse, result.coverage.coarse_uncovered, material);
    return result;
}

}  // namespace knead::tools
