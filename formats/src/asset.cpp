// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/asset.h"

#include <algorithm>
#include <cmath>

#include "failure.h"
#include "mesh_checks.h"
#include "offenders.h"

namespace knead {
namespace {

const std::string kGroup = "/knead/asset";
/// A unit quaternion may be this far from length 1: it went through text and float arithmetic.
constexpr double kUnitQuaternionTolerance = 1e-6;

template <std::size_t N>
bool all_finite(const std::array<double, N>& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

void check_free_nodes(const Asset& asset) {
    if (asset.free_node_count > asset.nodes_m.size())
        fail(ErrorCode::invalid_data,
             std::to_string(asset.free_node_count) + " free nodes of " + std::to_string(asset.nodes_m.size()),
             kGroup + "/mesh/free_node_count");
    Offenders held;
    for (std::size_t i = 0; i < asset.tetrahedra.size(); ++i)
        if (*std::min_element(asset.tetrahedra[i].begin(), asset.tetrahedra[i].end()) >=
            asset.free_node_count)
            held.add(i);
    if (held.any())
        fail(ErrorCode::invalid_data,
             held.text(asset.tetrahedra.size(), "tetrahedra have no free node", "elements"),
             kGroup + "/mesh/tetrahedra");
}

void check_palette(const Asset& asset) {
    const std::string at = kGroup + "/material";
    if (asset.palette.empty()) fail(ErrorCode::invalid_data, "the palette is empty", at);
    Offenders moduli, ratios, densities, outside;
    for (std::size_t i = 0; i < asset.palette.size(); ++i) {
        if (!is_positive(asset.palette[i].youngs_modulus_pa)) moduli.add(i);
        if (!is_poissons_ratio(asset.palette[i].poissons_ratio)) ratios.add(i);
        if (!is_positive(asset.palette[i].density_kg_per_m3)) densities.add(i);
    }
    const auto report = [&](const Offenders& bad, const char* what, const char* dataset) {
        if (bad.any())
            fail(ErrorCode::invalid_data, bad.text(asset.palette.size(), what, "entries"), at + dataset);
    };
    report(moduli, kNotPositive, "/palette/youngs_modulus_pa");
    report(ratios, kNotPoissonsRatio, "/palette/poissons_ratio");
    report(densities, kNotPositive, "/palette/density_kg_per_m3");
    const auto& index = asset.palette_index;
    if (index.size() != asset.tetrahedra.size())
        fail(ErrorCode::invalid_data,
             std::to_string(index.size()) + " entries for " + std::to_string(asset.tetrahedra.size()) +
                 " tetrahedra",
             at + "/palette_index");
    for (std::size_t i = 0; i < index.size(); ++i)
        if (index[i] >= asset.palette.size()) outside.add(i);
    if (outside.any())
        fail(ErrorCode::invalid_data, outside.text(index.size(), "entries name no palette entry", "elements"),
             at + "/palette_index");
}

void check_tool_shape(const ToolSet& tool, const std::string& where) {
    if (tool.shape > ToolShape::capsule)
        fail(ErrorCode::invalid_data, "the shape is none of plate, sphere, capsule", where);
    if (tool.shape != ToolShape::plate && !is_positive(tool.radius_m))
        fail(ErrorCode::invalid_data, "the radius of a sphere or capsule is not finite and > 0",
             where + "/radius_m");
    if (tool.shape == ToolShape::capsule && !is_positive(tool.half_length_m))
        fail(ErrorCode::invalid_data, "the half length of a capsule is not finite and > 0",
             where + "/half_length_m");
    const auto& half = tool.half_extents_m;
    const bool unbounded = half[0] == 0 && half[1] == 0;
    if (tool.shape == ToolShape::plate && !unbounded && !(is_positive(half[0]) && is_positive(half[1])))
        fail(ErrorCode::invalid_data,
             "the half extents of a plate are neither both 0 nor both finite and > 0",
             where + "/half_extents_m");
}

void check_tool_pose(const ToolSet& tool, const std::string& where) {
    if (!all_finite(tool.rest_position_m))
        fail(ErrorCode::invalid_data, "the rest position is not finite", where + "/rest_position_m");
    const auto& q = tool.rest_orientation_wxyz;
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(std::abs(length - 1) <= kUnitQuaternionTolerance))
        fail(ErrorCode::invalid_data, "the rest orientation is not a unit quaternion",
             where + "/rest_orientation_wxyz");
}

void check_tool_contact(const ToolSet& tool, const std::string& where) {
    if (tool.contact > ToolContact::coulomb)
        fail(ErrorCode::invalid_data, "the contact is none of bonded, sticking, frictionless, coulomb",
             where);
    if (tool.contact == ToolContact::coulomb &&
        !(is_positive(tool.friction_coefficient) && tool.friction_coefficient <= kMaxFrictionCoefficient))
        fail(ErrorCode::invalid_data, "the friction coefficient is not > 0 and at most 10",
             where + "/friction_coefficient");
}

void check_tool_nodes(const ToolSet& tool, std::uint32_t free_node_count, const std::string& where) {
    if (tool.contact == ToolContact::bonded && tool.nodes.empty())
        fail(ErrorCode::invalid_data, "the bonded tool \"" + tool.name + "\" has no node", where);
    Offenders bad;
    for (std::size_t i = 0; i < tool.nodes.size(); ++i)
        if (tool.nodes[i] >= free_node_count || (i > 0 && tool.nodes[i] <= tool.nodes[i - 1])) bad.add(i);
    if (bad.any())
        fail(ErrorCode::invalid_data,
             bad.text(tool.nodes.size(), "nodes are not free, or not in increasing order", "entries"), where);
}

void check_tools(const Asset& asset) {
    std::vector<std::string> names;
    for (const ToolSet& tool : asset.tools)
        names.push_back(tool.name);
    check_names(names, "a tool's name", kGroup + "/tools");
    for (const ToolSet& tool : asset.tools) {
        const std::string where = kGroup + "/tools/" + tool.name;
        check_tool_shape(tool, where);
        check_tool_pose(tool, where);
        check_tool_contact(tool, where);
        check_tool_nodes(tool, asset.free_node_count, where + "/nodes");
    }
}

void check_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::size_t corner_count,
                     const std::string& corner, const std::string& where) {
    Offenders bad;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto& [a, b, c] = triangles[i];
        const bool outside = a >= corner_count || b >= corner_count || c >= corner_count;
        if (outside || a == b || b == c || a == c) bad.add(i);
    }
    if (bad.any())
        fail(ErrorCode::invalid_data,
             bad.text(triangles.size(), "triangles name a " + corner + " twice or one that does not exist",
                      "triangles"),
             where);
}

/// Four weights of a vertex: finite, bounded and together 1.
bool are_weights(const std::array<float, 4>& weights) {
    double sum = 0;
    for (const float weight : weights) {
        if (!(std::abs(weight) <= kMaxEmbeddingWeight)) return false;
        sum += weight;
    }
    return std::abs(sum - 1) <= kEmbeddingWeightSumTolerance;
}

void check_embedding(const Asset& asset) {
    const SurfaceEmbedding& embedding = asset.embedding;
    const std::string at = kGroup + "/embedding";
    const std::size_t moving = embedding.tetrahedron.size();
    if (embedding.weights.size() != moving)
        fail(ErrorCode::invalid_data,
             std::to_string(embedding.weights.size()) + " rows of weights for " + std::to_string(moving) +
                 " vertices",
             at + "/weights");
    if (embedding.triangles.empty() && embedding.vertex_count() > 0)
        fail(ErrorCode::invalid_data, "vertices without a triangle", at + "/triangles");
    Offenders outside, weights, still;
    for (std::size_t i = 0; i < moving; ++i) {
        if (embedding.tetrahedron[i] >= asset.tetrahedra.size()) outside.add(i);
        if (!are_weights(embedding.weights[i])) weights.add(i);
    }
    for (std::size_t i = 0; i < embedding.still_vertices_m.size(); ++i)
        if (!all_finite(embedding.still_vertices_m[i])) still.add(i);
    if (outside.any())
        fail(ErrorCode::invalid_data, outside.text(moving, "vertices name no tetrahedron", "vertices"),
             at + "/tetrahedron");
    if (weights.any())
        fail(ErrorCode::invalid_data,
             weights.text(moving, "vertices have weights that do not add up to 1 or are larger than 16",
                          "vertices"),
             at + "/weights");
    if (still.any())
        fail(ErrorCode::invalid_data,
             still.text(embedding.still_vertices_m.size(), "positions are not finite", "entries"),
             at + "/still_vertices_m");
    check_triangles(embedding.triangles, embedding.vertex_count(), "vertex", at + "/triangles");
}

}  // namespace

Status validate(const Asset& asset) {
    return guarded(kGroup, [&] {
        check_text(asset.name, "the scene's name", kGroup);
        check_text(asset.level, "the level's name", kGroup);
        check_mesh(asset.nodes_m, asset.tetrahedra, kGroup + "/mesh");
        check_free_nodes(asset);
        check_palette(asset);
        check_tools(asset);
        if (!all_finite(asset.gravity_m_per_s2))
            fail(ErrorCode::invalid_data, "gravity is not finite", kGroup + "/gravity/acceleration_m_per_s2");
        if (!std::isfinite(asset.damping_per_s) || asset.damping_per_s < 0)
            fail(ErrorCode::invalid_data, "damping is not finite and >= 0",
                 kGroup + "/damping/mass_proportional_per_s");
        check_triangles(asset.surface.triangles, asset.nodes_m.size(), "node", kGroup + "/surface/triangles");
        check_embedding(asset);
        for (const Asset::Request& request : asset.requests) {
            check_text(request.group, "a request's group", "/provenance/requests/groups");
            check_text(request.scene_key, "a request's scene key", "/provenance/requests/scene_keys");
        }
        return Unit{};
    });
}

}  // namespace knead
