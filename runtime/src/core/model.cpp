// SPDX-License-Identifier: Apache-2.0
#include "core/model.h"

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

}  // namespace

Model build_model(const Asset& asset) {
    Model model;
    model.free_count = asset.free_node_count;
    model.rest_m.reserve(asset.nodes_m.size());
    for (const Point& p : asset.nodes_m)
        model.rest_m.emplace_back(p[0], p[1], p[2]);
    model.mass_kg.assign(asset.nodes_m.size(), 0);
    model.elements.reserve(asset.tetrahedra.size());
    for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
        Real mass = 0;
        model.elements.push_back(
            build_element(model.rest_m, asset.tetrahedra[t], asset.palette[asset.palette_index[t]], mass));
        for (const std::uint32_t node : asset.tetrahedra[t])
            model.mass_kg[node] += mass / 4;
    }
    for (std::uint32_t i = 0; i < model.free_count; ++i)
        model.free_mass_kg += model.mass_kg[i];
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

}  // namespace knead::core
