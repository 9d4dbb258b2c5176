// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/tool_place.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace knead::tools {
namespace {

double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The tool's x, y and z in the scene.
std::array<Point, 3> axes_of(const ToolSet& tool) {
    const auto& [w, x, y, z] = tool.rest_orientation_wxyz;
    return {{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
             {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
             {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}}};
}

Point from_tool(const ToolSet& tool, const Point& point_m) {
    const Point& origin = tool.rest_position_m;
    return {point_m[0] - origin[0], point_m[1] - origin[1], point_m[2] - origin[2]};
}

ToolGap gap_of_plate(const ToolSet& tool, const Point& point_m) {
    const std::array<Point, 3> axes = axes_of(tool);
    const Point arm = from_tool(tool, point_m);
    const Point local{dot(axes[0], arm), dot(axes[1], arm), dot(axes[2], arm)};
    ToolGap gap;
    if (tool.half_extents_m[0] > 0)
        gap.beside_m = std::hypot(std::max(0.0, std::abs(local[0]) - tool.half_extents_m[0]),
                                  std::max(0.0, std::abs(local[1]) - tool.half_extents_m[1]));
    gap.ahead_m = -local[2];
    gap.overlap_m = std::max(0.0, local[2]);
    gap.distance_m = std::hypot(gap.beside_m, std::max(0.0, -local[2]));
    return gap;
}

/// Distance of a point, seen from the tool's origin, from the segment that its ball is swept along.
double from_segment_m(const ToolSet& tool, const Point& axis, const Point& arm) {
    const double along = std::clamp(dot(arm, axis), -tool.half_length_m, tool.half_length_m);
    return std::hypot(arm[0] - along * axis[0], arm[1] - along * axis[1], arm[2] - along * axis[2]);
}

/// A ball, or one swept along the tool's z. The distance is a convex function of the way gone.
ToolGap gap_of_capsule(const ToolSet& tool, const Point& point_m) {
    constexpr int kHalvings = 60;  // of an interval in double precision: to rounding
    const Point axis = axes_of(tool)[2];
    const Point way = press_direction(tool);
    const Point arm = from_tool(tool, point_m);
    const auto distance_after = [&](double s) {
        return from_segment_m(tool, axis, {arm[0] - s * way[0], arm[1] - s * way[1], arm[2] - s * way[2]});
    };
    const double reach = std::hypot(arm[0], arm[1], arm[2]) + tool.half_length_m + tool.radius_m;
    double low = -reach, high = reach;
    for (int k = 0; k < 2 * kHalvings; ++k) {
        const double third = (high - low) / 3;
        if (distance_after(low + third) <= distance_after(high - third))
            high -= third;
        else
            low += third;
    }
    const double nearest_s = 0.5 * (low + high);
    ToolGap gap;
    gap.beside_m = std::max(0.0, distance_after(nearest_s) - tool.radius_m);
    gap.overlap_m = std::max(0.0, tool.radius_m - distance_after(0));
    gap.distance_m = std::max(0.0, distance_after(0) - tool.radius_m);
    if (gap.beside_m > 0) return gap;
    double outside = -2 * reach, inside = nearest_s;
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (outside + inside);
        (distance_after(middle) > tool.radius_m ? outside : inside) = middle;
    }
    gap.ahead_m = inside;
    return gap;
}

}  // namespace

Point press_direction(const ToolSet& tool) {
    const Point axis = axes_of(tool)[2];
    if (tool.shape != ToolShape::capsule) return {-axis[0], -axis[1], -axis[2]};
    if (axis[2] * axis[2] > 0.5) {
        const double sign = axis[2] > 0 ? -1 : 1;
        return {sign * axis[0], sign * axis[1], sign * axis[2]};
    }
    const double size = std::sqrt(1 - axis[2] * axis[2]);  // of what is left of straight down
    return {axis[2] * axis[0] / size, axis[2] * axis[1] / size, (axis[2] * axis[2] - 1) / size};
}

ToolGap gap_of(const ToolSet& tool, const Point& point_m) {
    return tool.shape == ToolShape::plate ? gap_of_plate(tool, point_m) : gap_of_capsule(tool, point_m);
}

}  // namespace knead::tools
