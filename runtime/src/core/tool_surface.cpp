// SPDX-License-Identifier: Apache-2.0
#include "core/tool_surface.h"

#include <algorithm>
#include <cmath>

namespace knead::core {

ToolSurface::ToolSurface(const ToolSet& tool)
    : shape_(tool.shape),
      bounded_(tool.shape == ToolShape::plate &&
               (tool.half_extents_m[0] != 0 || tool.half_extents_m[1] != 0)),
      radius_m_(tool.radius_m),
      half_length_m_(tool.shape == ToolShape::capsule ? tool.half_length_m : 0),
      half_extents_m_{Real(tool.half_extents_m[0]), Real(tool.half_extents_m[1])} {}

Vec ToolSurface::core_point(const Vec& local) const noexcept {
    return {0, 0, std::clamp(local.z(), -half_length_m_, half_length_m_)};
}

Real ToolSurface::depth(const Vec& local) const noexcept {
    if (shape_ == ToolShape::plate) return local.z();
    return radius_m_ - (local - core_point(local)).norm();
}

SurfacePoint ToolSurface::closest(const Vec& local) const noexcept {
    if (shape_ == ToolShape::plate) return {Vec(local.x(), local.y(), 0), Vec(0, 0, -1)};
    const Vec centre = core_point(local);
    const Vec away = local - centre;
    const Real distance = away.norm();
    const Vec outward = distance > 0 ? Vec(away / distance) : Vec(1, 0, 0);
    return {centre + radius_m_ * outward, outward};
}

bool ToolSurface::beside(const Vec& local) const noexcept {
    return bounded_ && (std::abs(local.x()) > half_extents_m_[0] || std::abs(local.y()) > half_extents_m_[1]);
}

}  // namespace knead::core
