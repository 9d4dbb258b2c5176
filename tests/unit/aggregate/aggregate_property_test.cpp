// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "aggregate/aggregate.h"
#include "cluster/cluster.h"
#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using namespace tools;

/// Volumes are sums of a few hundred terms in different orders.
constexpr double kRounding = 1e-9;

/// A jittered cube of random elasticities, clustered; now and then with a part cut off.
ClusteredObject any_object() {
    const auto n = static_cast<std::uint32_t>(*rc::gen::inRange(2, 6));
    ClusteredObject object;
    object.mesh = kuhn_cube(n);
    jitter(object.mesh, 0.1 / n, 0.12, *rc::gen::arbitrary<std::uint64_t>());
    std::mt19937_64 engine(*rc::gen::arbitrary<std::uint64_t>());
    const std::size_t count = object.mesh.tetrahedra.size();
    object.material = {{}, std::vector<double>(count, 0.3), std::vector<double>(count, 1000), {}};
    for (std::size_t t = 0; t < count; ++t)
        object.material.youngs_modulus_pa.push_back(2e3 + static_cast<double>(engine() % 40000));
    object.clustering = cluster_object(object.mesh, object.material,
                                       {.bins = static_cast<std::uint32_t>(*rc::gen::inRange(1, 5)),
                                        .clusters = static_cast<std::uint32_t>(*rc::gen::inRange(1, 6))})
                            .clustering;
    return object;
}

/// Gives every tetrahedron its own nodes along one of the faces of the cube's middle, so that two parts
/// remain.
void cut_in_two(TetMesh& mesh) {
    const std::size_t nodes = mesh.nodes_m.size();
    std::vector<std::uint32_t> copy(nodes, UINT32_MAX);
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        if (barycentre_m(mesh, t)[0] < 0.04) continue;
        for (std::uint32_t& node : mesh.tetrahedra[t]) {
            if (copy[node] == UINT32_MAX) {
                copy[node] = static_cast<std::uint32_t>(mesh.nodes_m.size());
                mesh.nodes_m.push_back(Point(mesh.nodes_m[node]));
            }
            node = copy[node];
        }
    }
}

AggregateOptions any_options() {
    return {.order = *rc::gen::arbitrary<bool>() ? BinOrder::stiff_first : BinOrder::soft_first,
            .interest = static_cast<InterestKind>(*rc::gen::inRange(0, 5))};
}

RC_GTEST_PROP(Aggregate_property, Volume_of_each_bin_is_conserved_to_one_tetrahedron_per_cluster, ()) {
    ClusteredObject object = any_object();
    if (*rc::gen::arbitrary<bool>()) cut_in_two(object.mesh);
    const AggregateOptions options = any_options();
    const AggregateResult result = aggregate(object, options);
    double largest = 0;
    for (std::size_t t = 0; t < object.mesh.tetrahedra.size(); ++t)
        largest = std::max(largest, signed_volume_m3(object.mesh, t));

    const auto& bins = object.clustering.bin_youngs_modulus_pa;
    std::vector<double> before(bins.size(), 0);
    std::vector<double> after(bins.size(), 0);
    for (std::size_t t = 0; t < object.mesh.tetrahedra.size(); ++t) {
        before[object.clustering.bin_of_tetrahedron[t]] += signed_volume_m3(object.mesh, t);
        after[result.material.bin_of_tetrahedron[t]] += signed_volume_m3(object.mesh, t);
    }
    const auto& of_cluster = object.clustering.bin_of_cluster;
    const std::size_t last = options.order == BinOrder::stiff_first ? 0 : bins.size() - 1;
    double grown = 0;  // tetrahedra that all bins but the last may have too many
    for (std::size_t bin = 0; bin < bins.size(); ++bin) {
        const auto clusters = static_cast<double>(
            std::count(of_cluster.begin(), of_cluster.end(), static_cast<std::uint32_t>(bin)));
        if (bin == last) continue;
        grown += clusters;
        RC_ASSERT(std::abs(after[bin] - before[bin]) <= clusters * largest + kRounding * before[bin]);
    }
    RC_ASSERT(std::abs(after[last] - before[last]) <= grown * largest + kRounding * before[last]);
    for (std::size_t bin = 0; bin < bins.size(); ++bin)
        RC_ASSERT(std::abs(result.bins[bin].after_m3 - after[bin]) <= kRounding * after[bin]);
    RC_ASSERT(validate(result.material, object.mesh.tetrahedra.size()).ok());
}

std::vector<std::uint32_t> any_order(std::size_t count) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), std::mt19937_64(*rc::gen::arbitrary<std::uint64_t>()));
    return order;
}

/// The same object with its nodes and tetrahedra numbered anew: new tetrahedron i is old order[i].
ClusteredObject renumbered(const ClusteredObject& object, const std::vector<std::uint32_t>& order,
                           const std::vector<std::uint32_t>& node_order) {
    ClusteredObject result = object;
    std::vector<std::uint32_t> new_node(node_order.size());
    for (std::uint32_t i = 0; i < node_order.size(); ++i) {
        new_node[node_order[i]] = i;
        result.mesh.nodes_m[i] = object.mesh.nodes_m[node_order[i]];
    }
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::uint32_t old = order[i];
        for (int corner = 0; corner < 4; ++corner)
            result.mesh.tetrahedra[i][corner] = new_node[object.mesh.tetrahedra[old][corner]];
        result.clustering.bin_of_tetrahedron[i] = object.clustering.bin_of_tetrahedron[old];
        result.clustering.cluster_of_tetrahedron[i] = object.clustering.cluster_of_tetrahedron[old];
    }
    return result;
}

RC_GTEST_PROP(Aggregate_property, Numbering_of_nodes_and_tetrahedra_does_not_matter, ()) {
    const ClusteredObject object = any_object();
    const AggregateOptions options = any_options();
    const auto order = any_order(object.mesh.tetrahedra.size());
    const auto node_order = any_order(object.mesh.nodes_m.size());
    const AggregateResult result = aggregate(object, options);
    const AggregateResult again = aggregate(renumbered(object, order, node_order), options);
    for (std::size_t i = 0; i < order.size(); ++i)
        RC_ASSERT(again.material.bin_of_tetrahedron[i] == result.material.bin_of_tetrahedron[order[i]]);
}

RC_GTEST_PROP(Aggregate_property, Renumbering_before_clustering_does_not_matter_either, ()) {
    const ClusteredObject object = any_object();
    const auto order = any_order(object.mesh.tetrahedra.size());
    ClusteredObject other = renumbered(object, order, any_order(object.mesh.nodes_m.size()));
    for (std::size_t i = 0; i < order.size(); ++i)
        other.material.youngs_modulus_pa[i] = object.material.youngs_modulus_pa[order[i]];
    const ClusterOptions options{.bins = 3, .clusters = 2};
    const Clustering a = cluster_object(object.mesh, object.material, options).clustering;
    const Clustering b = cluster_object(other.mesh, other.material, options).clustering;
    for (std::size_t i = 0; i < order.size(); ++i)
        RC_ASSERT(b.cluster_of_tetrahedron[i] == a.cluster_of_tetrahedron[order[i]]);
}

}  // namespace
}  // namespace knead::test
