// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "bake/embedding.h"
#include "bake/node_order.h"
#include "bake/selection.h"
#include "bake/surface.h"
#include "common/error.h"

namespace knead::tools {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

[[noreturn]] void fail_selection(const Scene& scene, const Selection& selection, const std::string& what) {
    fail_input(fmt::format("{}:{}: {} {}", scene.file.string(), selection.line, selection.scene_key, what));
}

std::vector<bool> held_nodes(const Scene& scene, const TetMesh& mesh) {
    std::vector<bool> held(mesh.nodes_m.size(), false);
    for (const Selection& selection : scene.held) {
        const std::vector<bool> selected = select_nodes(mesh, selection);
        if (std::find(selected.begin(), selected.end(), true) == selected.end())
            fail_selection(scene, selection, "selects no node of the mesh");
        for (std::size_t i = 0; i < held.size(); ++i)
            if (selected[i]) held[i] = true;
    }
    return held;
}

/// Indices of the tetrahedra with at least one free node.
std::vector<std::uint32_t> movable_tetrahedra(const TetMesh& mesh, const std::vector<bool>& held) {
    std::vector<std::uint32_t> movable;
    for (std::uint32_t i = 0; i < mesh.tetrahedra.size(); ++i) {
        const Tetrahedron& t = mesh.tetrahedra[i];
        if (!std::all_of(t.begin(), t.end(), [&](std::uint32_t node) { return held[node]; }))
            movable.push_back(i);
    }
    return movable;
}

/// Places the nodes: free ones in nested-dissection order, then the held ones that a movable tetrahedron
/// uses, in the mesh's order. Fills the asset's nodes and free_node_count.
/// @return asset node of each mesh node; kNone for one that is not in the asset
std::vector<std::uint32_t> place_nodes(const TetMesh& mesh, const std::vector<std::uint32_t>& movable,
                                       const std::vector<bool>& held, Asset& asset) {
    std::vector<Tetrahedron> tetrahedra;
    std::vector<bool> used(mesh.nodes_m.size(), false);
    for (const std::uint32_t i : movable) {
        tetrahedra.push_back(mesh.tetrahedra[i]);
        for (const std::uint32_t node : mesh.tetrahedra[i])
            used[node] = true;
    }
    std::vector<bool> free(mesh.nodes_m.size());
    for (std::size_t i = 0; i < free.size(); ++i)
        free[i] = used[i] && !held[i];
    std::vector<std::uint32_t> order = nested_dissection_order(tetrahedra, free);
    asset.free_node_count = static_cast<std::uint32_t>(order.size());
    for (std::uint32_t i = 0; i < used.size(); ++i)
        if (used[i] && held[i]) order.push_back(i);

    std::vector<std::uint32_t> asset_node(mesh.nodes_m.size(), kNone);
    for (const std::uint32_t node : order) {
        asset_node[node] = static_cast<std::uint32_t>(asset.nodes_m.size());
        asset.nodes_m.push_back(mesh.nodes_m[node]);
    }
    return asset_node;
}

/// Palette entries in the order of increasing (E, nu, density). Values are compared to the bit: tetrahedra
/// of one bin hold identical values.
/// @return the mesh's tetrahedra in the order of the asset's
std::vector<std::uint32_t> place_tetrahedra(const MaterialObject& object, std::vector<std::uint32_t> movable,
                                            const std::vector<std::uint32_t>& asset_node, Asset& asset) {
    const auto lowest_node = [&](std::uint32_t i) {
        const Tetrahedron& t = object.mesh.tetrahedra[i];
        return std::min({asset_node[t[0]], asset_node[t[1]], asset_node[t[2]], asset_node[t[3]]});
    };
    // Neighbours in memory are neighbours in space: the element pass runs through both arrays.
    std::stable_sort(movable.begin(), movable.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return lowest_node(a) < lowest_node(b); });

    const Material& material = object.material;
    const auto values_of = [&](std::uint32_t i) {
        return std::tuple(material.youngs_modulus_pa[i], material.poissons_ratio[i],
                          material.density_kg_per_m3[i]);
    };
    std::map<std::tuple<double, double, double>, std::uint32_t> palette;
    for (const std::uint32_t i : movable)
        palette.emplace(values_of(i), 0);
    for (auto& [values, index] : palette) {
        index = static_cast<std::uint32_t>(asset.palette.size());
        asset.palette.push_back({std::get<0>(values), std::get<1>(values), std::get<2>(values)});
    }
    for (const std::uint32_t i : movable) {
        Tetrahedron t = object.mesh.tetrahedra[i];
        for (std::uint32_t& node : t)
            node = asset_node[node];
        asset.tetrahedra.push_back(t);
        asset.palette_index.push_back(palette.at(values_of(i)));
    }
    return movable;
}

/// How far the tool's lowest point lies below its origin.
double reach_below_m(const SceneTool& tool) {
    if (tool.shape == ToolShape::plate) return 0;
    const auto& [w, x, y, z] = tool.orientation_wxyz;
    const double axis_z = 1 - 2 * (x * x + y * y);  // of the tool's z axis, in the scene
    return tool.radius_m + tool.half_length_m * std::abs(axis_z);
}

/// Where the tool is when it just touches the highest of its nodes: over the middle of them.
Point touching_position(const SceneTool& tool, const std::vector<Point>& nodes_m,
                        const std::vector<std::uint32_t>& touched) {
    Point low = nodes_m[touched.front()];
    Point high = low;
    for (const std::uint32_t node : touched) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], nodes_m[node][axis]);
            high[axis] = std::max(high[axis], nodes_m[node][axis]);
        }
    }
    return {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), high[2] + reach_below_m(tool)};
}

ToolSet place_tool(const Scene& scene, const SceneTool& tool, const TetMesh& mesh,
                   const std::vector<bool>& on_surface, const std::vector<std::uint32_t>& asset_node,
                   const Asset& asset) {
    ToolSet set;
    set.name = tool.name;
    set.shape = tool.shape;
    set.contact = tool.contact;
    set.radius_m = tool.radius_m;
    set.half_length_m = tool.half_length_m;
    set.friction_coefficient = tool.friction_coefficient;
    set.half_extents_m = tool.half_extents_m;
    set.rest_orientation_wxyz = tool.orientation_wxyz;
    const std::vector<bool> selected = select_nodes(mesh, tool.touches);
    for (std::size_t i = 0; i < selected.size(); ++i)
        if (selected[i] && on_surface[i] && asset_node[i] < asset.free_node_count)
            set.nodes.push_back(asset_node[i]);
    if (set.nodes.empty())
        fail_selection(scene, tool.touches, "selects no node of the surface that can move");
    std::sort(set.nodes.begin(), set.nodes.end());
    set.rest_position_m = tool.position_m.value_or(touching_position(tool, asset.nodes_m, set.nodes));
    return set;
}

std::vector<bool> surface_nodes(const TetMesh& mesh, const std::vector<Triangle>& surface) {
    std::vector<bool> on_surface(mesh.nodes_m.size(), false);
    for (const Triangle& triangle : surface)
        for (const std::uint32_t node : triangle)
            on_surface[node] = true;
    return on_surface;
}

SurfaceEmbedding place_skin(const Scene& scene, const TetMesh& mesh, const Skin& skin,
                            const std::vector<std::uint32_t>& placed) {
    CarrierMesh carrier{mesh.nodes_m, {}, placed.size()};
    std::vector<bool> in_asset(mesh.tetrahedra.size(), false);
    for (const std::uint32_t i : placed) {
        in_asset[i] = true;
        carrier.tetrahedra.push_back(mesh.tetrahedra[i]);
    }
    for (std::size_t i = 0; i < in_asset.size(); ++i)
        if (!in_asset[i]) carrier.tetrahedra.push_back(mesh.tetrahedra[i]);
    return embed(skin, carrier,
                 {fmt::format("{}:{}: embedding", scene.file.string(), scene.embedding->line),
                  scene.embedding->max_distance_m});
}

/// Which line of the scene asked for each group of the file (docs/format.md names the groups).
void note_requests(const Scene& scene, const Level& level, Asset& asset) {
    asset.requests.push_back({"/knead/asset/mesh", "mesh", level.mesh ? level.line : scene.mesh_line});
    asset.requests.push_back({"/knead/asset/material", level.bins > 0 ? "level" : "material",
                              level.bins > 0 ? level.line : scene.material_line});
    for (std::size_t i = 0; i < scene.tools.size(); ++i)
        asset.requests.push_back(
            {fmt::format("/knead/asset/tools/{:06}", i), fmt::format("tool[{}]", i), scene.tools[i].line});
    if (scene.gravity_m_per_s2 != Point{})
        asset.requests.push_back({"/knead/asset/gravity", "simulation.gravity_m_per_s2", scene.gravity_line});
    if (scene.damping_per_s != 0)
        asset.requests.push_back({"/knead/asset/damping", "simulation.damping_per_s", scene.damping_line});
    if (scene.needs_surface)
        asset.requests.push_back({"/knead/asset/surface", "app.surface", scene.surface_line});
    if (scene.embedding)
        asset.requests.push_back({"/knead/asset/embedding", "embedding", scene.embedding->line});
}

}  // namespace

Asset bake(const Scene& scene, const Level& level, const MaterialObject& object, const Skin& skin) {
    Asset asset;
    asset.name = scene.name;
    asset.level = level.name;
    asset.gravity_m_per_s2 = scene.gravity_m_per_s2;
    asset.damping_per_s = scene.damping_per_s;

    const std::vector<bool> held = held_nodes(scene, object.mesh);
    const std::vector<std::uint32_t> movable = movable_tetrahedra(object.mesh, held);
    if (movable.empty())
        fail_input(fmt::format("{}:{}: every node of the mesh is held: nothing can move", scene.file.string(),
                               scene.held.front().line));
    const std::vector<std::uint32_t> asset_node = place_nodes(object.mesh, movable, held, asset);
    const std::vector<std::uint32_t> placed = place_tetrahedra(object, movable, asset_node, asset);

    // The surface is that of the whole object: a face between a movable and a held tetrahedron is inside it.
    const std::vector<Triangle> surface = boundary_triangles(object.mesh.tetrahedra);
    const std::vector<bool> on_surface = surface_nodes(object.mesh, surface);
    for (const SceneTool& tool : scene.tools)
        asset.tools.push_back(place_tool(scene, tool, object.mesh, on_surface, asset_node, asset));
    if (scene.needs_surface) {
        for (const Triangle& t : surface)
            if (asset_node[t[0]] != kNone && asset_node[t[1]] != kNone && asset_node[t[2]] != kNone)
                asset.surface.triangles.push_back({asset_node[t[0]], asset_node[t[1]], asset_node[t[2]]});
    }
    if (scene.embedding) asset.embedding = place_skin(scene, object.mesh, skin, placed);
    note_requests(scene, level, asset);
    if (const Status status = validate(asset); !status.ok()) fail_input(status.error().text());
    return asset;
}

}  // namespace knead::tools
