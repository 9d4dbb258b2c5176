// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "reference/contact_problem.h"

namespace knead::tools {

/// The point of a tool's surface nearest to a place, in the tool's frame.
struct SurfacePoint {
    double gap_m = 0;                     ///< distance of the place from the surface, negative inside
    Eigen::Vector3d foot_m;               ///< on the surface
    Eigen::Vector3d normal;               ///< outward, unit length: the gradient of the gap
    Eigen::Matrix3d gap_curvature_per_m;  ///< second derivative of the gap at the place
};

/// The geometry of one rigid tool at one pose.
class ToolSurface {
  public:
    /// @throws ToolError(bad_input) for sizes or a pose that make no sense
    explicit ToolSurface(const ContactTool& tool);

    [[nodiscard]] SurfacePoint nearest(const Eigen::Vector3d& local_m) const;
    /// Past the rectangle of a bounded plate, whose side walls do not touch.
    [[nodiscard]] bool beside(const Eigen::Vector3d& local_m) const;
    [[nodiscard]] bool is_curved() const { return shape_ != ToolShape::plate; }

    [[nodiscard]] Eigen::Vector3d to_local(const Eigen::Vector3d& scene_m) const {
        return rotation_.transpose() * (scene_m - origin_);
    }
    [[nodiscard]] Eigen::Vector3d to_scene(const Eigen::Vector3d& local_m) const {
        return rotation_ * local_m + origin_;
    }
    [[nodiscard]] const Eigen::Matrix3d& rotation() const { return rotation_; }
    [[nodiscard]] const Eigen::Vector3d& origin_m() const { return origin_; }

  private:
    ToolShape shape_;
    double radius_, half_length_;
    Eigen::Vector2d half_extents_;
    Eigen::Matrix3d rotation_;
    Eigen::Vector3d origin_;
};

/// Columns: `normal` and two tangents to it.
[[nodiscard]] Eigen::Matrix3d frame_along(const Eigen::Vector3d& normal);

}  // namespace knead::tools
