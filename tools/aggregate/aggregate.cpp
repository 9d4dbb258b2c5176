// SPDX-License-Identifier: GPL-3.0-or-later
#include "aggregate/aggregate.h"

#include <cmath>
#include <queue>
#include <tuple>

#include "aggregate/face_neighbours.h"
#include "aggregate/tetrahedron_tree.h"
#include "common/error.h"

namespace knead::tools {
namespace {

/// A cluster is full when it lacks less than this share of its volume: the two volumes are sums in different
/// orders, and rounding must not cost a tetrahedron. A single one of 10^8 tetrahedra is larger.
constexpr double kVolumeRounding = 1e-9;
constexpr std::uint32_t kUnmodified = UINT32_MAX;

std::vector<ClusterShape> shapes_of(const Clustering& clustering) {
    std::vector<ClusterShape> shapes(clustering.bin_of_cluster.size());
    for (std::size_t cluster = 0; cluster < shapes.size(); ++cluster) {
        shapes[cluster].barycentre_m = clustering.cluster_barycentre_m[cluster];
        shapes[cluster].volume_m3 = clustering.cluster_volume_m3[cluster];
    }
    for (std::uint32_t t = 0; t < clustering.cluster_of_tetrahedron.size(); ++t)
        shapes[clustering.cluster_of_tetrahedron[t]].tetrahedra.push_back(t);
    return shapes;
}

/// A tetrahedron on the list of interest; the smallest comes first.
struct Candidate {
    double interest;
    double squared_distance_m2;  ///< decides between equal interests
    std::uint32_t tetrahedron;

    bool operator>(const Candidate& other) const {
        return std::tie(interest, squared_distance_m2, tetrahedron) >
               std::tie(other.interest, other.squared_distance_m2, other.tetrahedron);
    }
};

/// The state of Algorithm 1: which tetrahedra have been modified, and by which bin.
class Growth {
  public:
    Growth(const ClusteredObject& object, const AggregateOptions& options)
        : mesh_(object.mesh),
          clustering_(object.clustering),
          options_(options),
          neighbours_(face_neighbours(object.mesh.tetrahedra)),
          tree_(object.mesh),
          bin_of_(object.mesh.tetrahedra.size(), kUnmodified),
          listed_by_(object.mesh.tetrahedra.size(), kUnmodified) {}

    void grow_cluster(std::uint32_t cluster, const ClusterShape& shape) {
        const Interest interest(options_.interest, options_.direction_weight, mesh_, shape);
        const double wanted_m3 = shape.volume_m3 * (1.0 - kVolumeRounding);
        double modified_m3 = 0;
        list_ = {};
        enlist(start_of(shape), cluster, shape, interest);
        while (modified_m3 < wanted_m3) {
            if (list_.empty()) {
                const auto next = tree_.nearest_present(shape.barycentre_m);
                if (!next) return;  // every tetrahedron is modified
                ++jumps_;
                enlist(*next, cluster, shape, interest);
            }
            const std::uint32_t tetrahedron = list_.top().tetrahedron;
            list_.pop();
            for (const std::uint32_t neighbour : neighbours_[tetrahedron])
                if (neighbour != kNoNeighbour) enlist(neighbour, cluster, shape, interest);
            if (bin_of_[tetrahedron] != kUnmodified) continue;
            bin_of_[tetrahedron] = clustering_.bin_of_cluster[cluster];
            tree_.remove(tetrahedron);
            modified_m3 += signed_volume_m3(mesh_, tetrahedron);
        }
    }

    void give_rest_to(std::uint32_t bin) {
        for (std::uint32_t& of_tetrahedron : bin_of_)
            if (of_tetrahedron == kUnmodified) of_tetrahedron = bin;
    }

    [[nodiscard]] const std::vector<std::uint32_t>& bin_of() const { return bin_of_; }
    [[nodiscard]] std::uint64_t jumps() const { return jumps_; }

  private:
    std::uint32_t start_of(const ClusterShape& shape) const {
        const auto inside = tree_.containing(shape.barycentre_m);
        return inside ? *inside : tree_.nearest(shape.barycentre_m);
    }

    /// Puts a tetrahedron on the list, once per cluster.
    void enlist(std::uint32_t tetrahedron, std::uint32_t cluster, const ClusterShape& shape,
                const Interest& interest) {
        if (listed_by_[tetrahedron] == cluster) return;
        listed_by_[tetrahedron] = cluster;
        const Point barycentre = barycentre_m(mesh_, tetrahedron);
        double squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double offset = barycentre[axis] - shape.barycentre_m[axis];
            squared += offset * offset;
        }
        const bool member = clustering_.cluster_of_tetrahedron[tetrahedron] == cluster;
        list_.push({interest(barycentre, member), squared, tetrahedron});
    }

    const TetMesh& mesh_;
    const Clustering& clustering_;
    const AggregateOptions& options_;
    FaceNeighbours neighbours_;
    TetrahedronTree tree_;
    std::vector<std::uint32_t> bin_of_;     ///< [tetrahedra] bin that modified it, or kUnmodified
    std::vector<std::uint32_t> listed_by_;  ///< [tetrahedra] last cluster that had it on its list
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> list_;
    std::uint64_t jumps_ = 0;
};

Material material_of(const Clustering& clustering, const std::vector<std::uint32_t>& bin_of) {
    Material material;
    material.bin_of_tetrahedron = bin_of;
    for (const std::uint32_t bin : bin_of) {
        material.youngs_modulus_pa.push_back(clustering.bin_youngs_modulus_pa[bin]);
        material.poissons_ratio.push_back(clustering.bin_poissons_ratio[bin]);
        material.density_kg_per_m3.push_back(clustering.bin_density_kg_per_m3[bin]);
    }
    return material;
}

std::vector<BinVolume> volumes_of(const ClusteredObject& object, const std::vector<std::uint32_t>& bin_of) {
    std::vector<BinVolume> volumes(object.clustering.bin_youngs_modulus_pa.size());
    for (std::size_t t = 0; t < bin_of.size(); ++t) {
        const double volume = signed_volume_m3(object.mesh, t);
        volumes[object.clustering.bin_of_tetrahedron[t]].before_m3 += volume;
        volumes[bin_of[t]].after_m3 += volume;
    }
    return volumes;
}

}  // namespace

AggregateResult aggregate(const ClusteredObject& object, const AggregateOptions& options) {
    if (!std::isfinite(options.direction_weight) || options.direction_weight < 0)
        fail_usage("the direction weight must be finite and not negative");
    const Clustering& clustering = object.clustering;
    const auto bins = static_cast<std::uint32_t>(clustering.bin_youngs_modulus_pa.size());
    const std::vector<ClusterShape> shapes = shapes_of(clustering);
    Growth growth(object, options);
    for (std::uint32_t turn = 0; turn + 1 < bins; ++turn) {
        const std::uint32_t bin = options.order == BinOrder::stiff_first ? bins - 1 - turn : turn;
        for (std::uint32_t cluster = 0; cluster < shapes.size(); ++cluster)
            if (clustering.bin_of_cluster[cluster] == bin) growth.grow_cluster(cluster, shapes[cluster]);
    }
    growth.give_rest_to(options.order == BinOrder::stiff_first ? 0 : bins - 1);

    AggregateResult result;
    result.material = material_of(clustering, growth.bin_of());
    result.bins = volumes_of(object, growth.bin_of());
    result.jumps = growth.jumps();
    return result;
}

}  // namespace knead::tools
