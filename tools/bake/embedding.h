// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "bake/skin.h"
#include "knead/formats/asset.h"

namespace knead::tools {

/// The mesh that carries a skin: all of the object, the part that cannot move included.
struct CarrierMesh {
    const std::vector<Point>& nodes_m;
    std::vector<Tetrahedron> tetrahedra;  ///< those of the asset first, in its order and with its corners
    std::size_t moving_count = 0;         ///< how many of them are in the asset
};

/// Where the user asked for the skin, and how far it may stand off.
struct EmbeddingRequest {
    std::string where;          ///< begins every message: "steak.toml:40: embedding"
    double max_distance_m = 0;  ///< 0: kDefaultEmbeddingDistance
};

/// Of the longest edge of the mesh's bounding box: what a coarse mesh cuts off a rounded object.
inline constexpr double kDefaultEmbeddingDistance = 0.05;

/// Ties each vertex of `skin` to the tetrahedron that holds it, or to the nearest one, whose affine map is
/// then continued outwards: barycentric weights of the vertex itself, not of its projection. Of several
/// equally near ones: one that moves, then the one with the smallest largest weight, then the first. A vertex
/// whose tetrahedron is not in the asset stays where it is (SurfaceEmbedding::still_vertices_m).
///
/// Throws ToolError(bad_input) when vertices are farther outside than allowed, when weights pass
/// kMaxEmbeddingWeight (vertices far outside of thin tetrahedra), or when no vertex moves; says how many and
/// which, numbered from 0 as in the skin.
[[nodiscard]] SurfaceEmbedding embed(const Skin& skin, const CarrierMesh& mesh,
                                     const EmbeddingRequest& request);

}  // namespace knead::tools
