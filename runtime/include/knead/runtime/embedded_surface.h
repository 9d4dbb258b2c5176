// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "knead/formats/asset.h"
#include "knead/formats/result.h"
#include "knead/runtime/export.h"

namespace knead {

/// The surface for drawing that the tetrahedra of an object carry along (SurfaceEmbedding of its asset).
///
/// Apart from Simulation: nothing of it runs in step(). Update it as often as you draw, on the thread that
/// steps or, from a copy of the positions, on another one. Vertices stand in the order of the asset: first
/// those that move, then the still ones.
///
/// Threads: a constant once made; any number may call update() at a time. Allocates when made only.
class KNEAD_RUNTIME_API EmbeddedSurface {
  public:
    /// Reads and validates an asset and keeps what is said of its surface.
    /// @return the surface, or any error of read_asset(), or invalid_argument: the asset has no embedding
    static Result<EmbeddedSurface> load(const std::filesystem::path& asset_file);
    /// The same from memory; validates `asset`.
    static Result<EmbeddedSurface> create(const Asset& asset);

    /// Of those that move and those that stay together.
    [[nodiscard]] std::size_t vertex_count() const noexcept {
        return corners_.size() + still_vertices_m_.size();
    }
    /// Vertex indices, turned as in the surface that the scene named. They never change.
    [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& triangles() const noexcept {
        return triangles_;
    }
    /// Where the vertices are when the object's nodes are at `positions_m`.
    /// @param positions_m [nodes of the asset][3], metres, as Simulation::positions_m() gives them
    /// @param vertices_m [vertex_count()][3], metres, scene frame: written
    void update(const double* positions_m, float* vertices_m) const noexcept;

  private:
    explicit EmbeddedSurface(const Asset& asset);

    std::vector<std::array<std::uint32_t, 4>> corners_;  ///< [moving vertices] asset nodes
    std::vector<std::array<float, 3>> weights_;          ///< [moving vertices] of all corners but the first
    std::vector<std::array<float, 3>> still_vertices_m_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace knead
