// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "knead/formats/asset.h"
#include "knead/formats/material.h"
#include "stability/scenario_press.h"

namespace knead::test {

/// An asset and where its nodes come from.
struct PressAsset {
    Asset asset;
    std::vector<std::uint32_t> mesh_node;  ///< [asset nodes] node of the mesh
};

/// The paper's press as the runtime wants it: lowest nodes held, highest nodes bonded to a plate.
///
/// Made by hand, without the baking tool: what is compared here is the solvers. Free nodes keep the order of
/// the mesh, held ones come last; the palette holds every different (E, nu, density) once.
inline PressAsset press_asset(const PressedCube& cube) {
    const auto& [mesh, material, press] = cube;
    PressAsset result;
    Asset& asset = result.asset;
    asset.name = "press";
    asset.level = "fine";
    std::vector<bool> is_held(mesh.nodes_m.size());
    for (const std::uint32_t node : press.held_nodes)
        is_held[node] = true;
    std::vector<std::uint32_t> asset_node(mesh.nodes_m.size());
    for (const bool held : {false, true}) {
        for (std::uint32_t n = 0; n < mesh.nodes_m.size(); ++n) {
            if (is_held[n] != held) continue;
            asset_node[n] = static_cast<std::uint32_t>(result.mesh_node.size());
            result.mesh_node.push_back(n);
            asset.nodes_m.push_back(mesh.nodes_m[n]);
        }
        if (!held) asset.free_node_count = static_cast<std::uint32_t>(result.mesh_node.size());
    }
    std::map<std::tuple<double, double, double>, std::uint32_t> palette;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        Tetrahedron nodes = mesh.tetrahedra[t];
        for (std::uint32_t& node : nodes)
            node = asset_node[node];
        asset.tetrahedra.push_back(nodes);
        const PaletteEntry entry{material.youngs_modulus_pa[t], material.poissons_ratio[t],
                                 material.density_kg_per_m3[t]};
        const auto [at, is_new] =
            palette.try_emplace({entry.youngs_modulus_pa, entry.poissons_ratio, entry.density_kg_per_m3},
                                static_cast<std::uint32_t>(asset.palette.size()));
        if (is_new) asset.palette.push_back(entry);
        asset.palette_index.push_back(at->second);
    }
    ToolSet plate;
    plate.name = "plate";
    plate.shape = ToolShape::plate;
    plate.contact = ToolContact::bonded;
    plate.rest_position_m = mesh.nodes_m[press.plate_nodes.front()];
    for (const std::uint32_t node : press.plate_nodes)
        plate.nodes.push_back(asset_node[node]);
    asset.tools.push_back(plate);
    return result;
}

}  // namespace knead::test
