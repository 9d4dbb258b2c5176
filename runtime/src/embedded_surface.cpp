// SPDX-License-Identifier: Apache-2.0
#include "knead/runtime/embedded_surface.h"

#include <cstring>
#include <new>

namespace knead {

EmbeddedSurface::EmbeddedSurface(const Asset& asset) : triangles_(asset.embedding.triangles) {
    const SurfaceEmbedding& embedding = asset.embedding;
    for (const std::uint32_t tetrahedron : embedding.tetrahedron)
        corners_.push_back(asset.tetrahedra[tetrahedron]);
    for (const auto& w : embedding.weights)
        weights_.push_back({w[1], w[2], w[3]});
    for (const Point& p : embedding.still_vertices_m)
        still_vertices_m_.push_back(
            {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
}

Result<EmbeddedSurface> EmbeddedSurface::create(const Asset& asset) {
    try {
        if (Status status = validate(asset); !status) return status.error();
        if (asset.embedding.triangles.empty())
            return Error{ErrorCode::invalid_argument,
                         "the asset has no embedded surface: its scene has no [embedding]", asset.name};
        return EmbeddedSurface(asset);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, "the surface does not fit into memory", asset.name};
    }
}

void EmbeddedSurface::update(const double* positions_m, float* vertices_m) const noexcept {
    for (std::size_t v = 0; v < corners_.size(); ++v) {
        const auto& corners = corners_[v];
        const double* first = positions_m + std::size_t{3} * corners[0];
        double offset[3] = {0, 0, 0};
        // Relative to a corner, so that the rounding of the weights does not count the way to the origin.
        for (std::size_t k = 0; k < 3; ++k) {
            const double* corner = positions_m + std::size_t{3} * corners[k + 1];
            for (std::size_t axis = 0; axis < 3; ++axis)
                offset[axis] += static_cast<double>(weights_[v][k]) * (corner[axis] - first[axis]);
        }
        for (std::size_t axis = 0; axis < 3; ++axis)
            vertices_m[3 * v + axis] = static_cast<float>(first[axis] + offset[axis]);
    }
    if (!still_vertices_m_.empty())
        std::memcpy(vertices_m + 3 * corners_.size(), still_vertices_m_.data(),
                    still_vertices_m_.size() * sizeof still_vertices_m_[0]);
}

}  // namespace knead
