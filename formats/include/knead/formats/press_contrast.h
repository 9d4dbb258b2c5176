// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "knead/formats/asset.h"

namespace knead {
namespace detail {

/// How the nodes of an asset hang together while its tetrahedra are added one after the other: which of them
/// the fixed nodes hold by now. Union-find; the members of a set are linked in a ring.
class HeldNodes {
  public:
    explicit HeldNodes(const Asset& asset)
        : parent_(asset.nodes_m.size()),
          next_(asset.nodes_m.size()),
          size_(asset.nodes_m.size(), 1),
          held_by_pa_(asset.nodes_m.size(), 0),
          fixed_(asset.free_node_count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
        std::iota(next_.begin(), next_.end(), 0U);
        for (std::size_t i = fixed_; i < parent_.size(); ++i)
            join(fixed_, static_cast<std::uint32_t>(i), std::numeric_limits<double>::infinity());
        if (fixed_ < parent_.size()) held_by_pa_[fixed_] = std::numeric_limits<double>::infinity();
    }

    /// Ties the corners of a tetrahedron together. @param youngs_modulus_pa never more than the time before
    void add(const Tetrahedron& corners, double youngs_modulus_pa) {
        for (std::size_t k = 1; k < corners.size(); ++k)
            join(corners[0], corners[k], youngs_modulus_pa);
    }

    /// The softest tetrahedron on the stiffest path from `node` to a fixed node; 0 while there is none.
    [[nodiscard]] double held_by_pa(std::uint32_t node) const noexcept { return held_by_pa_[node]; }

  private:
    std::uint32_t root(std::uint32_t node) noexcept {
        while (parent_[node] != node) {
            parent_[node] = parent_[parent_[node]];
            node = parent_[node];
        }
        return node;
    }

    void join(std::uint32_t a, std::uint32_t b, double youngs_modulus_pa) noexcept {
        a = root(a);
        b = root(b);
        if (a == b) return;
        if (fixed_ < parent_.size()) {  // what was not held and now is, once for every node
            const std::uint32_t ground = root(fixed_);
            if (a == ground) set_held(b, youngs_modulus_pa);
            if (b == ground) set_held(a, youngs_modulus_pa);
        }
        if (size_[a] < size_[b]) std::swap(a, b);
        parent_[b] = a;
        size_[a] += size_[b];
        std::swap(next_[a], next_[b]);
    }

    void set_held(std::uint32_t set, double youngs_modulus_pa) noexcept {
        std::uint32_t node = set;
        do {
            held_by_pa_[node] = youngs_modulus_pa;
            node = next_[node];
        } while (node != set);
    }

    std::vector<std::uint32_t> parent_;
    std::vector<std::uint32_t> next_;  ///< of the same set, in a ring
    std::vector<std::uint32_t> size_;
    std::vector<double> held_by_pa_;
    std::uint32_t fixed_;  ///< the first fixed node stands for all of them
};

}  // namespace detail

/// The softest tetrahedron that the force of a tool cannot avoid on its way to what holds the object.
///
/// The largest elasticity for which the tetrahedra of at least that elasticity connect every tool to the
/// fixed nodes: a bonded tool by any of its nodes (the others follow it), a unilateral one by each of its
/// nodes, for any of them may be the one that is touched. The softest elasticity of all where something is
/// not connected at all: no fixed node, no tool with a node, or a part by itself. Time n log n in the
/// tetrahedra; the result does not depend on their order. Precondition: validate(asset).ok().
[[nodiscard]] inline double path_youngs_modulus_pa(const Asset& asset) {
    const auto modulus = [&asset](std::uint32_t t) {
        return asset.palette[asset.palette_index[t]].youngs_modulus_pa;
    };
    std::vector<std::uint32_t> order(asset.tetrahedra.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return modulus(a) != modulus(b) ? modulus(a) > modulus(b) : a < b;
    });
    detail::HeldNodes held(asset);
    for (const std::uint32_t t : order)
        held.add(asset.tetrahedra[t], modulus(t));

    double path = std::numeric_limits<double>::infinity();
    for (const ToolSet& tool : asset.tools) {
        if (tool.nodes.empty()) continue;  // it touches nothing
        double weakest = std::numeric_limits<double>::infinity(), strongest = 0;
        for (const std::uint32_t node : tool.nodes) {
            weakest = std::min(weakest, held.held_by_pa(node));
            strongest = std::max(strongest, held.held_by_pa(node));
        }
        path = std::min(path, tool.contact == ToolContact::bonded ? strongest : weakest);
    }
    const bool connected = path > 0 && path < std::numeric_limits<double>::infinity();
    return connected ? path : modulus(order.back());
}

}  // namespace knead
