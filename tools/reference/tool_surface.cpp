// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/tool_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace knead::tools {
namespace {

// How far the norm of a unit quaternion may be from one.
constexpr double kUnitTolerance = 1e-6;

bool positive(double value) {
    return std::isfinite(value) && value > 0;
}

void check_sizes(const ContactTool& tool) {
    if (tool.shape == ToolShape::plate) {
        const auto& half = tool.half_extents_m;
        const bool unbounded = half[0] == 0 && half[1] == 0;
        if (!unbounded && !(positive(half[0]) && positive(half[1])))
            fail_input(
                fmt::format("contact tool: half extents {} and {} are neither both positive nor both 0",
                            half[0], half[1]));
        return;
    }
    if (!positive(tool.radius_m))
        fail_input(fmt::format("contact tool: radius {} is not finite and positive", tool.radius_m));
    if (tool.shape == ToolShape::capsule && !(tool.half_length_m == 0 || positive(tool.half_length_m)))
        fail_input(fmt::format("contact tool: half length {} is not finite and >= 0", tool.half_length_m));
}

}  // namespace

ToolSurface::ToolSurface(const ContactTool& tool)
    : shape_(tool.shape),
      radius_(tool.radius_m),
      half_length_(tool.shape == ToolShape::capsule ? tool.half_length_m : 0),
      half_extents_(tool.half_extents_m[0], tool.half_extents_m[1]),
      origin_(tool.pose.position_m.data()) {
    check_sizes(tool);
    const auto& q = tool.pose.orientation_wxyz;
    const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
    if (!origin_.allFinite() || !(std::abs(turn.norm() - 1) <= kUnitTolerance))
        fail_input("contact tool: the pose is not finite or its quaternion not of unit length");
    rotation_ = turn.normalized().toRotationMatrix();
}

SurfacePoint ToolSurface::nearest(const Eigen::Vector3d& local_m) const {
    SurfacePoint result;
    if (shape_ == ToolShape::plate) {
        result.gap_m = -local_m.z();
        result.foot_m = Eigen::Vector3d(local_m.x(), local_m.y(), 0);
        result.normal = -Eigen::Vector3d::UnitZ();
        result.gap_curvature_per_m.setZero();
        return result;
    }
    const double along = std::clamp(local_m.z(), -half_length_, half_length_);
    const Eigen::Vector3d centre(0, 0, along);
    const Eigen::Vector3d out = local_m - centre;
    const double distance = out.norm();
    const bool on_cylinder = std::abs(local_m.z()) < half_length_;
    if (distance > 0) {
        result.normal = out / distance;
    } else {
        result.normal = on_cylinder ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
    }
    result.gap_m = distance - radius_;
    result.foot_m = centre + radius_ * result.normal;
    Eigen::Matrix3d around = Eigen::Matrix3d::Identity() - result.normal * result.normal.transpose();
    if (on_cylinder) around(2, 2) = 0;  // the normal has no part along z there
    result.gap_curvature_per_m = around / std::max(distance, radius_ / 2);  // finite at the centre
    return result;
}

bool ToolSurface::beside(const Eigen::Vector3d& local_m) const {
    if (shape_ != ToolShape::plate || half_extents_.isZero(0)) return false;
    return std::abs(local_m.x()) > half_extents_.x() || std::abs(local_m.y()) > half_extents_.y();
}

Eigen::Matrix3d frame_along(const Eigen::Vector3d& normal) {
    Eigen::Matrix3d frame;
    frame.col(0) = normal;
    frame.col(1) = normal.unitOrthogonal();
    frame.col(2) = normal.cross(frame.col(1));
    return frame;
}

}  // namespace knead::tools
