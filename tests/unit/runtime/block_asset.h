// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "knead/formats/asset.h"
#include "support/kuhn_cube.h"

namespace knead::test {

constexpr PaletteEntry kGel{22e3, 0.3, 1000};  ///< the paper's homogenised cube: 22 kPa, 1 kg
constexpr double kOnPlane_m = 1e-9;            ///< nodes of a grid are on its planes up to rounding

using NodeTest = std::function<bool(const Point&)>;

/// An asset of one material from a mesh: nodes for which `is_held` are numbered last. Other order is kept.
inline Asset asset_of(const TetMesh& mesh, const NodeTest& is_held, const PaletteEntry& material = kGel) {
    Asset asset;
    asset.name = "test";
    asset.level = "only";
    std::vector<std::uint32_t> new_index(mesh.nodes_m.size());
    for (const bool held : {false, true}) {
        for (std::size_t i = 0; i < mesh.nodes_m.size(); ++i) {
            if (is_held(mesh.nodes_m[i]) != held) continue;
            new_index[i] = static_cast<std::uint32_t>(asset.nodes_m.size());
            asset.nodes_m.push_back(mesh.nodes_m[i]);
        }
        if (!held) asset.free_node_count = static_cast<std::uint32_t>(asset.nodes_m.size());
    }
    for (Tetrahedron t : mesh.tetrahedra) {
        for (std::uint32_t& node : t)
            node = new_index[node];
        bool moves = false;
        for (const std::uint32_t node : t)
            moves = moves || node < asset.free_node_count;
        if (moves) asset.tetrahedra.push_back(t);
    }
    asset.palette = {material};
    asset.palette_index.assign(asset.tetrahedra.size(), 0);
    return asset;
}

/// The free nodes of an asset for which `touches`, as tools list them.
inline std::vector<std::uint32_t> free_nodes(const Asset& asset, const NodeTest& touches) {
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t i = 0; i < asset.free_node_count; ++i) {
        if (touches(asset.nodes_m[i])) nodes.push_back(i);
    }
    return nodes;
}

inline NodeTest at_height(double z_m) {
    return [z_m](const Point& p) { return std::abs(p[2] - z_m) < kOnPlane_m; };
}

/// The paper's cube on its table: n^3 cells, bottom held, one tool at the top face's middle.
inline Asset cube_asset(std::uint32_t n, ToolShape shape, ToolContact contact,
                        const PaletteEntry& material = kGel) {
    constexpr double kSide_m = 0.1;
    Asset asset = asset_of(kuhn_cube(n, kSide_m), at_height(0), material);
    ToolSet tool;
    tool.name = "tool";
    tool.shape = shape;
    tool.contact = contact;
    tool.rest_position_m = {kSide_m / 2, kSide_m / 2, kSide_m};
    if (shape != ToolShape::plate) {
        tool.radius_m = 0.02;
        tool.rest_position_m[2] += tool.radius_m;
    }
    if (shape == ToolShape::capsule) {  // lying, along y
        tool.half_length_m = 0.02;
        tool.rest_orientation_wxyz = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};
    }
    if (contact == ToolContact::coulomb) tool.friction_coefficient = 0.4;
    tool.nodes = free_nodes(asset, at_height(kSide_m));
    asset.tools = {tool};
    return asset;
}

/// Every tetrahedron an elasticity of its own: soft and stiff (2-6 and 38-42 kPa), stiff more often above.
inline void make_heterogeneous(Asset& asset, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    const auto uniform = [&engine] { return static_cast<double>(engine() >> 11U) * 0x1.0p-53; };
    asset.palette.clear();
    for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
        const bool above = asset.nodes_m[asset.tetrahedra[t][0]][2] > 0.05;
        const bool stiff = uniform() < (above ? 2.0 / 3 : 1.0 / 3);
        asset.palette.push_back({(stiff ? 38e3 : 2e3) + 4e3 * uniform(), 0.3, 1000});
        asset.palette_index[t] = static_cast<std::uint32_t>(t);
    }
}

}  // namespace knead::test
