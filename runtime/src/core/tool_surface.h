// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/types.h"
#include "knead/formats/asset.h"

namespace knead::core {

/// A place on a tool's surface, in the tool's frame.
struct SurfacePoint {
    Vec place = Vec::Zero();
    Vec outward = Vec::Zero();  ///< unit normal
};

/// The surface of a tool in its own frame: the face of a plate (the plane z = 0, looking along -z; its
/// rectangle may be bounded, its sides and its back never touch), a ball, or a capsule.
class ToolSurface {
  public:
    /// @param tool valid
    explicit ToolSurface(const ToolSet& tool);

    /// Signed distance, inside positive: how far a point is in the ball or capsule, or behind the plane of
    /// the plate's face. Never changes faster than the point moves.
    [[nodiscard]] Real depth(const Vec& local) const noexcept;

    /// The closest place on the surface, for a plate on the whole plane. On the middle of a ball or capsule,
    /// where all directions are equally close, one that is always the same.
    [[nodiscard]] SurfacePoint closest(const Vec& local) const noexcept;

    /// Past the edge of a bounded plate, in front of it or behind.
    [[nodiscard]] bool beside(const Vec& local) const noexcept;

    /// Whether the normal is the same everywhere.
    [[nodiscard]] bool flat() const noexcept { return shape_ == ToolShape::plate; }

  private:
    /// The nearest point of the middle: the ball's centre, the capsule's axis.
    [[nodiscard]] Vec core_point(const Vec& local) const noexcept;

    ToolShape shape_;
    bool bounded_;
    Real radius_m_;
    Real half_length_m_;  ///< zero: a ball
    std::array<Real, 2> half_extents_m_;
};

}  // namespace knead::core
