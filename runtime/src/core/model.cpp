// SPDX-License-Identifier: Apache-2.0
#include "core/model.h"

#include <algorithm>
#include <cmath>

#include "core/loose_parts.h"

namespace knead::core {
namespace {

Element build_element(const Field& rest, const Tetrahedron& nodes, const PaletteEntry& material, Real& mass) {
    Element element;
    element.nodes = nodes;
    Mat edges;
    for (int k = 0; k < 3; ++k)
        edges.col(k) = rest[nodes[k + 1]] - rest[nodes[0]];
    // The inverse by cross products: its rows are gradients, its determinant six times the volume.
    const Vec a = edges.col(1).cross(edges.col(2));
    const Real determinant = edges.col(0).dot(a);
    element.rest_inverse.row(0) = a / determinant;
    element.rest_inverse.row(1) = edges.col(2).cross(edges.col(0)) / determinant;
    element.rest_inverse.row(2) = edges.col(0).cross(edges.col(1)) / determinant;
    const Real volume = determinant / 6;
    const Real e = material.youngs_modulus_pa;
    const Real nu = material.poissons_ratio;
    element.mu_volume = volume * e / (2 * (1 + nu));
    element.lambda_volume = volume * e * nu / ((1 + nu) * (1 - 2 * nu));
    mass = volume * material.density_kg_per_m3;
    return element;
}

/// Free nodes in the asset's order, then those of each bonded tool, then the fixed ones. A node that two
/// bonded tools list goes with the first.
void number_nodes(const Asset& asset, const std::vector<std::size_t>& tools, Model& model) {
    constexpr std::size_t kNobody = ~std::size_t{0};
    std::vector<std::size_t> holder(asset.nodes_m.size(), kNobody);
    for (std::size_t k = tools.size(); k-- > 0;) {
        if (asset.tools[tools[k]].contact != ToolContact::bonded) continue;
        for (const std::uint32_t node : asset.tools[tools[k]].nodes)
            holder[node] = k;
    }
    std::uint32_t next = 0;
    model.from_asset.resize(asset.nodes_m.size());
    const auto number = [&](std::size_t who) {
        const std::uint32_t begin = next;
        for (std::uint32_t i = 0; i < asset.free_node_count; ++i) {
            if (holder[i] == who) model.from_asset[i] = next++;
        }
        return Model::Range{begin, next};
    };
    model.free_count = number(kNobody).end;
    for (std::size_t k = 0; k < tools.size(); ++k)
        model.bonded.push_back(number(k));
    model.moving_count = next;
    for (std::size_t i = asset.free_node_count; i < asset.nodes_m.size(); ++i)
        model.from_asset[i] = next++;
}

void add_elements(const Asset& asset, Model& model) {
    model.mass_kg.assign(asset.nodes_m.size(), 0);
    model.elements.reserve(asset.tetrahedra.size());
    for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
        Tetrahedron nodes = asset.tetrahedra[t];
        for (std::uint32_t& node : nodes)
            node = model.from_asset[node];
        Real mass = 0;
        model.elements.push_back(
            build_element(model.rest_m, nodes, asset.palette[asset.palette_index[t]], mass));
        for (const std::uint32_t node : nodes)
            model.mass_kg[node] += mass / 4;
    }
}

}  // namespace

Model build_model(const Asset& asset, const std::vector<std::size_t>& tools) {
    Model model;
    number_nodes(asset, tools, model);
    model.rest_m.resize(asset.nodes_m.size());
    for (std::size_t i = 0; i < asset.nodes_m.size(); ++i) {
        const Point& p = asset.nodes_m[i];
        model.rest_m[model.from_asset[i]] = Vec(p[0], p[1], p[2]);
    }
    add_elements(asset, model);
    model.loose_parts = find_loose_parts(model);
    for (std::uint32_t i = 0; i < model.free_count; ++i)
        model.free_mass_kg += model.mass_kg[i];
    Real volume = 0;
    for (const Element& element : model.elements)
        volume += 1 / (6 * element.rest_inverse.determinant());
    const Real mean_volume = volume / static_cast<Real>(std::max<std::size_t>(1, model.elements.size()));
    model.mean_edge_m = std::cbrt(6 * std::sqrt(Real(2)) * mean_volume);
    Vec low = model.rest_m.front(), high = low;
    for (const Vec& x : model.rest_m) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    model.size_m = (high - low).norm();
    model.gravity_m_per_s2 =
        Vec(asset.gravity_m_per_s2[0], asset.gravity_m_per_s2[1], asset.gravity_m_per_s2[2]);
    model.damping_per_s = asset.damping_per_s;
    return model;
}

std::vector<ToolSet> renumbered(const Asset& asset, const std::vector<std::size_t>& tools,
                                const Model& model) {
    std::vector<ToolSet> result;
    for (const std::size_t k : tools) {
        result.push_back(asset.tools[k]);
        for (std::uint32_t& node : result.back().nodes)
            node = model.from_asset[node];
        std::sort(result.back().nodes.begin(), result.back().nodes.end());
    }
    return result;
}

std::vector<std::uint32_t> touchable(const Asset& asset, const std::vector<std::size_t>& tools,
                                     const Model& model) {
    std::vector<std::uint32_t> result;
    for (const std::size_t k : tools) {
        if (asset.tools[k].contact == ToolContact::bonded) continue;
        for (const std::uint32_t node : asset.tools[k].nodes) {
            if (model.from_asset[node] < model.free_count) result.push_back(model.from_asset[node]);
        }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

}  // namespace knead::core
