// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "quality/gate.h"
#include "quality/union_find.h"

namespace knead::tools {
namespace {

/// Longest over shortest edge beyond what was tested (docs/stability.md: 1:1000).
constexpr double kTestedGrading = 1000;
/// Of the squared extent of the held nodes: below it they are on one line, or one point, to within rounding.
constexpr double kOnOneLine = 1e-12;

/// "3 of 12 tetrahedra ... (17, 204 and 1 more)"
std::string some_of(const std::vector<std::uint32_t>& found, std::size_t total) {
    constexpr std::size_t kNamed = 5;
    std::string text = fmt::format("{} of {} tetrahedra (", found.size(), total);
    for (std::size_t i = 0; i < std::min(found.size(), kNamed); ++i)
        text += fmt::format("{}{}", i == 0 ? "" : ", ", found[i]);
    return text + (found.size() > kNamed ? ", ...)" : ")");
}

/// Parts that share no node, and how many of them neither a held node nor a bonded tool keeps in place.
struct Parts {
    std::uint32_t count = 0;
    std::uint32_t loose = 0;
};

Parts parts_of(const Asset& asset) {
    UnionFind joined(asset.nodes_m.size());
    for (const Tetrahedron& t : asset.tetrahedra)
        for (std::size_t k = 1; k < 4; ++k)
            joined.join(t[0], t[k]);
    const std::vector<std::uint32_t> part = joined.labels();
    Parts parts{1 + *std::max_element(part.begin(), part.end()), 0};
    std::vector<bool> kept(parts.count, false);
    for (std::size_t n = asset.free_node_count; n < part.size(); ++n)
        kept[part[n]] = true;
    for (const ToolSet& tool : asset.tools)
        if (tool.contact == ToolContact::bonded)
            for (const std::uint32_t node : tool.nodes)
                kept[part[node]] = true;
    parts.loose = static_cast<std::uint32_t>(std::count(kept.begin(), kept.end(), false));
    return parts;
}

/// Largest squared area of a triangle of the first held node, the held node farthest from it and a third one,
/// over the fourth power of that distance. Zero when all are on one line.
bool held_on_one_line(const Asset& asset) {
    const auto first = asset.nodes_m.begin() + asset.free_node_count;
    const auto squared = [](const Point& p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; };
    const auto from_first = [&](const Point& p) {
        return Point{p[0] - (*first)[0], p[1] - (*first)[1], p[2] - (*first)[2]};
    };
    Point far{};
    for (auto node = first; node != asset.nodes_m.end(); ++node)
        if (const Point arm = from_first(*node); squared(arm) > squared(far)) far = arm;
    double widest = 0;
    for (auto node = first; node != asset.nodes_m.end(); ++node) {
        const Point arm = from_first(*node);
        widest =
            std::max(widest, squared({arm[1] * far[2] - arm[2] * far[1], arm[2] * far[0] - arm[0] * far[2],
                                      arm[0] * far[1] - arm[1] * far[0]}));
    }
    return widest <= kOnOneLine * squared(far) * squared(far);
}

void examine_parts(const Asset& asset, const MeshQuality& mesh, Findings& findings) {
    if (mesh.bodies > 1) {
        const Parts parts = parts_of(asset);
        findings.push_back(
            {true, "disconnected-parts", static_cast<double>(parts.count), "",
             fmt::format("the object has {} parts that share no node, {} of which nothing holds", parts.count,
                         parts.loose),
             "join them in the mesh (knead-mesh import --merge-duplicate-nodes), or leave out what nothing "
             "touches"});
    }
    const std::size_t held = asset.nodes_m.size() - asset.free_node_count;
    if (held == 0)
        findings.push_back({false, "free-floating", 0, "", "nothing holds the object: it flies freely",
                            "add a [[held]] to the scene if it should not"});
    else if (held_on_one_line(asset))
        findings.push_back(
            {true, "barely-held", static_cast<double>(held), "",
             fmt::format("the {} held nodes are on one line: the object swings about it", held),
             "hold at least three nodes that are not on a line"});
}

}  // namespace

Findings examine_shapes(const Asset& asset, const MeshQuality& mesh) {
    Findings findings;
    const std::size_t total = asset.tetrahedra.size();
    if (!mesh.slivers.empty())
        findings.push_back(
            {true, "sliver", mesh.min_radius_ratio, "",
             fmt::format("{} have a radius ratio below {:g}, the worst one {:.2g} with dihedral angles from "
                         "{:.2g} to {:.4g} degrees: they lock what is around them and take iterations",
                         some_of(mesh.slivers, total), kSliverRadiusRatio, mesh.min_radius_ratio,
                         mesh.worst.front().shape.min_dihedral_deg,
                         mesh.worst.front().shape.max_dihedral_deg),
             "mesh anew with another edge length, or without --round"});
    if (!mesh.near_inverted.empty()) {
        double thinnest = 1;
        for (const std::uint32_t i : mesh.near_inverted) {
            const Tetrahedron& t = asset.tetrahedra[i];
            thinnest = std::min(thinnest, shape_of(asset.nodes_m[t[0]], asset.nodes_m[t[1]],
                                                   asset.nodes_m[t[2]], asset.nodes_m[t[3]])
                                              .thinness);
        }
        findings.push_back(
            {true, "nearly-inverted", thinnest, "",
             fmt::format("{} are thinner than {:g} of their longest edge ({:.2g} the thinnest): a strain of "
                         "that much turns them inside out",
                         some_of(mesh.near_inverted, total), kInvertedByStrain, thinnest),
             "mesh anew with another edge length"});
    }
    if (const double grading = mesh.longest_edge_m / mesh.shortest_edge_m; grading > kTestedGrading)
        findings.push_back(
            {true, "grading", grading, "",
             fmt::format("the longest edge ({:.3g} m) is {:.3g} times the shortest ({:.3g} m); "
                         "tested up to {:g}",
                         mesh.longest_edge_m, grading, mesh.shortest_edge_m, kTestedGrading),
             "mesh anew with --edge-length; remove the finest details from the surface"});
    examine_parts(asset, mesh, findings);
    return findings;
}

}  // namespace knead::tools
