// SPDX-License-Identifier: Apache-2.0
#include "core/tool_surface.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace knead::test {
namespace {

using core::Frame;
using core::SurfacePoint;
using core::ToolSurface;
using core::Vec;

/// Lengths here are up to 0.3 m; a dozen roundings of doubles.
constexpr double kRounding_m = 1e-15;
/// Central differences of this step are good to their curvature: step^2 / radius^2.
constexpr double kStep_m = 1e-6;
constexpr double kSlopeTolerance = 1e-6;

double share() {
    return *rc::gen::inRange(-1000000, 1000001) / 1e6;
}

Vec point_in_box(double half_m) {
    return half_m * Vec(share(), share(), share());
}

ToolSet tool_of(ToolShape shape) {
    ToolSet tool;
    tool.shape = shape;
    if (shape != ToolShape::plate) tool.radius_m = 0.01 + 0.01 * std::abs(share());
    if (shape == ToolShape::capsule) tool.half_length_m = 0.01 + 0.03 * std::abs(share());
    return tool;
}

/// Distance from the segment between two points, by its parameter.
double distance_from_segment(const Vec& p, const Vec& a, const Vec& b) {
    const double at = (p - a).dot(b - a) / (b - a).squaredNorm();
    if (at <= 0) return (p - a).norm();
    if (at >= 1) return (p - b).norm();
    return ((p - a).cross(b - a)).norm() / (b - a).norm();
}

double expected_depth(const ToolSet& tool, const Frame& frame, const Vec& scene) {
    const Vec axis = frame.rotation.col(2);
    switch (tool.shape) {
        case ToolShape::plate:
            return axis.dot(scene - frame.position);
        case ToolShape::sphere:
            return tool.radius_m - (scene - frame.position).norm();
        default:
            return tool.radius_m - distance_from_segment(scene, frame.position - tool.half_length_m * axis,
                                                         frame.position + tool.half_length_m * axis);
    }
}

Frame any_frame() {
    core::Quat turn(share(), share(), share(), share());
    if (turn.norm() < 0.1) turn = core::Quat::Identity();
    return {point_in_box(0.1), turn.normalized().toRotationMatrix()};
}

constexpr ToolShape kShapes[] = {ToolShape::plate, ToolShape::sphere, ToolShape::capsule};

RC_GTEST_PROP(ToolSurface, depth_is_the_signed_distance_in_any_pose, ()) {
    for (const ToolShape shape : kShapes) {
        const ToolSet tool = tool_of(shape);
        const Frame frame = any_frame();
        const Vec scene = frame.position + point_in_box(0.08);
        const double depth = ToolSurface(tool).depth(frame.to_local(scene));
        RC_ASSERT(std::abs(depth - expected_depth(tool, frame, scene)) < 10 * kRounding_m);
    }
}

RC_GTEST_PROP(ToolSurface, closest_point_is_on_it_as_far_as_the_depth_along_the_normal, ()) {
    for (const ToolShape shape : kShapes) {
        const ToolSurface surface(tool_of(shape));
        const Vec local = point_in_box(0.08);
        const SurfacePoint closest = surface.closest(local);
        RC_ASSERT(std::abs(surface.depth(closest.place)) < kRounding_m);
        RC_ASSERT(std::abs(closest.outward.norm() - 1) < 1e-15);
        RC_ASSERT((closest.place - surface.depth(local) * closest.outward - local).norm() < kRounding_m);
    }
}

RC_GTEST_PROP(ToolSurface, normal_points_to_where_the_depth_falls, ()) {
    for (const ToolShape shape : kShapes) {
        const ToolSurface surface(tool_of(shape));
        const Vec local = point_in_box(0.08);
        RC_PRE(Vec(local.x(), local.y(), 0).norm() > 5e-3);  // not on the middle, where the slope jumps
        Vec slope;
        for (int axis = 0; axis < 3; ++axis) {
            const Vec step = kStep_m * Vec::Unit(axis);
            slope[axis] = (surface.depth(local + step) - surface.depth(local - step)) / (2 * kStep_m);
        }
        RC_ASSERT((slope + surface.closest(local).outward).norm() < kSlopeTolerance);
    }
}

TEST(ToolSurface, of_a_ball_and_a_capsule_has_a_normal_in_its_middle_too) {
    ToolSet tool;
    tool.radius_m = 0.01;
    tool.half_length_m = 0.02;
    for (const ToolShape shape : {ToolShape::sphere, ToolShape::capsule}) {
        tool.shape = shape;
        const ToolSurface surface(tool);
        const SurfacePoint closest = surface.closest(Vec::Zero());
        EXPECT_EQ(closest.outward.norm(), 1);
        EXPECT_NEAR(closest.place.norm(), 0.01, 1e-17);
        EXPECT_NEAR(surface.depth(Vec::Zero()), 0.01, 1e-17);
    }
}

TEST(ToolSurface, of_a_bounded_plate_ends_at_its_edges_and_of_others_nowhere) {
    ToolSet tool;
    const Vec past_x(0.021, 0, -1), past_y(0, -0.011, 1), inside(0.019, 0.009, 5);
    EXPECT_FALSE(ToolSurface(tool).beside(past_x));
    tool.half_extents_m = {0.02, 0.01};
    EXPECT_TRUE(ToolSurface(tool).beside(past_x));
    EXPECT_TRUE(ToolSurface(tool).beside(past_y));
    EXPECT_FALSE(ToolSurface(tool).beside(inside));
    tool.shape = ToolShape::sphere;
    tool.radius_m = 0.01;
    EXPECT_FALSE(ToolSurface(tool).beside(past_x));
}

}  // namespace
}  // namespace knead::test
