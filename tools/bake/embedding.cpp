// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/embedding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "bake/tetrahedron_tree.h"
#include "common/error.h"

namespace knead::tools {
namespace {

/// Of the object's size: a vertex on the face between two tetrahedra is as near to the one as to the other.
constexpr double kSamePlace = 1e-9;
constexpr std::size_t kNamedVertices = 5;

double largest_weight(const NearTetrahedron& near) {
    double largest = 0;
    for (const double weight : near.weights)
        largest = std::max(largest, std::abs(weight));
    return largest;
}

NearTetrahedron best_of(const std::vector<NearTetrahedron>& near, std::size_t moving_count) {
    return *std::min_element(near.begin(), near.end(), [&](const auto& a, const auto& b) {
        const auto rank = [&](const NearTetrahedron& n) {
            return std::tuple(n.tetrahedron >= moving_count, largest_weight(n), n.tetrahedron);
        };
        return rank(a) < rank(b);
    });
}

std::string ids(const std::vector<std::uint32_t>& vertices) {
    const auto end =
        vertices.begin() + static_cast<std::ptrdiff_t>(std::min(vertices.size(), kNamedVertices));
    return fmt::format("vertices {}{}", fmt::join(vertices.begin(), end, ", "),
                       vertices.size() > kNamedVertices ? ", ..." : "");
}

/// The tetrahedron of each vertex of the skin.
std::vector<NearTetrahedron> carriers(const Skin& skin, const CarrierMesh& mesh,
                                      const EmbeddingRequest& request) {
    const NearestTetrahedra tree(mesh.nodes_m, mesh.tetrahedra);
    const double max_distance_m =
        request.max_distance_m > 0 ? request.max_distance_m : kDefaultEmbeddingDistance * tree.size_m();
    std::vector<NearTetrahedron> carriers;
    std::vector<std::uint32_t> far, thin;
    double farthest_m = 0;
    for (std::uint32_t v = 0; v < skin.vertices_m.size(); ++v) {
        const NearTetrahedron near =
            best_of(tree.nearest(skin.vertices_m[v], kSamePlace * tree.size_m()), mesh.moving_count);
        farthest_m = std::max(farthest_m, near.distance_m);
        if (near.distance_m > max_distance_m)
            far.push_back(v);
        else if (near.tetrahedron < mesh.moving_count && largest_weight(near) > double{kMaxEmbeddingWeight})
            thin.push_back(v);
        carriers.push_back(near);
    }
    if (!far.empty())
        fail_input(fmt::format(
            "{}: {} of {} vertices lie more than {:g} m outside of the mesh ({}), the farthest {:g} "
            "m: is the length unit right?",
            request.where, far.size(), skin.vertices_m.size(), max_distance_m, ids(far), farthest_m));
    if (!thin.empty())
        fail_input(
            fmt::format("{}: {} of {} vertices lie too far outside of the thin tetrahedra nearest to them "
                        "({}): their weights pass {}",
                        request.where, thin.size(), skin.vertices_m.size(), ids(thin), kMaxEmbeddingWeight));
    return carriers;
}

}  // namespace

SurfaceEmbedding embed(const Skin& skin, const CarrierMesh& mesh, const EmbeddingRequest& request) {
    const std::vector<NearTetrahedron> carrier_of = carriers(skin, mesh, request);
    const auto moves = [&](std::size_t v) { return carrier_of[v].tetrahedron < mesh.moving_count; };
    SurfaceEmbedding embedding;
    std::vector<std::uint32_t> place(carrier_of.size());
    for (std::size_t v = 0; v < carrier_of.size(); ++v) {
        if (!moves(v)) continue;
        const auto& w = carrier_of[v].weights;
        place[v] = static_cast<std::uint32_t>(embedding.tetrahedron.size());
        embedding.tetrahedron.push_back(carrier_of[v].tetrahedron);
        embedding.weights.push_back({float(w[0]), float(w[1]), float(w[2]), float(w[3])});
    }
    if (embedding.tetrahedron.empty())
        fail_input(request.where + ": all of its vertices belong to the part of the object that cannot move");
    for (std::size_t v = 0; v < carrier_of.size(); ++v) {
        if (moves(v)) continue;
        place[v] = static_cast<std::uint32_t>(embedding.vertex_count());
        embedding.still_vertices_m.push_back(skin.vertices_m[v]);
    }
    embedding.triangles = skin.triangles;
    for (auto& triangle : embedding.triangles)
        for (std::uint32_t& vertex : triangle)
            vertex = place[vertex];
    return embedding;
}

}  // namespace knead::tools
