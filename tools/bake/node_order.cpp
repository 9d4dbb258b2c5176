// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/node_order.h"

#include <metis.h>

#include <algorithm>
#include <limits>

#include "common/error.h"
#include "common/metis_lock.h"

namespace knead::tools {
namespace {

constexpr idx_t kSeed = 1;  // METIS matches and splits at random: fixed, so that the order is too

/// Adjacency of the free nodes in compressed rows, numbered by their place among the free nodes.
struct Graph {
    std::vector<idx_t> offsets;
    std::vector<idx_t> neighbours;
};

Graph node_graph(const std::vector<Tetrahedron>& tetrahedra, const std::vector<bool>& free,
                 const std::vector<idx_t>& place, std::size_t free_count) {
    std::vector<std::pair<idx_t, idx_t>> edges;
    for (const Tetrahedron& t : tetrahedra)
        for (const std::uint32_t a : t)
            for (const std::uint32_t b : t)
                if (a != b && free[a] && free[b]) edges.emplace_back(place[a], place[b]);
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    Graph graph;
    graph.offsets.assign(free_count + 1, 0);
    for (const auto& [a, b] : edges) {
        ++graph.offsets[static_cast<std::size_t>(a) + 1];
        graph.neighbours.push_back(b);
    }
    for (std::size_t i = 0; i < free_count; ++i)
        graph.offsets[i + 1] += graph.offsets[i];
    return graph;
}

}  // namespace

std::vector<std::uint32_t> nested_dissection_order(const std::vector<Tetrahedron>& tetrahedra,
                                                   const std::vector<bool>& free) {
    if (tetrahedra.size() > static_cast<std::size_t>(std::numeric_limits<idx_t>::max()) / 12)
        fail_input("the mesh has too many tetrahedra for METIS's index type");
    std::vector<std::uint32_t> free_nodes;
    std::vector<idx_t> place(free.size(), -1);
    for (std::size_t i = 0; i < free.size(); ++i) {
        if (!free[i]) continue;
        place[i] = static_cast<idx_t>(free_nodes.size());
        free_nodes.push_back(static_cast<std::uint32_t>(i));
    }
    Graph graph = node_graph(tetrahedra, free, place, free_nodes.size());
    if (graph.neighbours.empty()) return free_nodes;  // METIS refuses a graph without edges

    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = kSeed;
    options[METIS_OPTION_NUMBERING] = 0;
    auto count = static_cast<idx_t>(free_nodes.size());
    std::vector<idx_t> order(free_nodes.size());
    std::vector<idx_t> place_in_order(free_nodes.size());
    const auto lock = lock_metis();
    const int status = METIS_NodeND(&count, graph.offsets.data(), graph.neighbours.data(), nullptr, options,
                                    order.data(), place_in_order.data());
    if (status != METIS_OK) throw std::runtime_error("METIS_NodeND failed with " + std::to_string(status));
    std::vector<std::uint32_t> ordered;
    ordered.reserve(order.size());
    for (const idx_t i : order)
        ordered.push_back(free_nodes[static_cast<std::size_t>(i)]);
    return ordered;
}

}  // namespace knead::tools
