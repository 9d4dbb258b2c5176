// SPDX-License-Identifier: Apache-2.0
#include "core/contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "knead/formats/tool_names.h"
#include "unit/runtime/press.h"

namespace knead::test {
namespace {

using core::Vec;

/// No slip: two independent programs. Free slip: the factor 1.033 of the design's experiments, known to 3
/// digits.
constexpr double kPressedCube_n = 23.82645;
constexpr double kPressedCubeTolerance_n = 1e-5;
/// A pull of the object on the tool that is solver error, relative to the largest push.
constexpr double kPullTolerance = 1e-4;

struct Trace {
    std::vector<Vec3> forces_n;
    std::vector<std::uint32_t> touched;
    std::uint32_t status = 0;
    double largest_push_n = 0;
    double largest_pull_n = 0;
    double deepest_m = 0;  ///< of any tool node inside the tool
};

constexpr std::uint32_t kCells = 5;  ///< along an edge of the cube in the touch tests
constexpr double kClearance_m = 0.001;
constexpr double kDt_s = 1e-3;

/// In one smooth second: from kClearance_m above the object to `depth_m` inside and back; then off by 20 mm.
double height_at(double time_s, double depth_m) {
    if (time_s > 1) return kClearance_m + 0.2 * (time_s - 1);
    return kClearance_m - (depth_m + kClearance_m) * (1 - std::cos(2 * EIGEN_PI * time_s)) / 2;
}

double depth_of(const ToolSet& tool, const Pose& pose, const Vec& node) {
    const Vec local = node - Vec(pose.position_m[0], pose.position_m[1], pose.position_m[2]);
    if (tool.shape == ToolShape::plate) return local.z();
    const double past_the_end = std::abs(local.y()) - tool.half_length_m;  // a capsule here lies along y
    return tool.radius_m - std::hypot(local.x(), std::max(0.0, past_the_end), local.z());
}

Trace press_and_leave(const Asset& asset, double depth_m) {
    Stepper stepper(asset, {});
    Trace trace;
    for (int i = 1; i <= 1100; ++i) {
        const Pose pose = moved(asset, {0, 0, height_at(i * kDt_s, depth_m)});
        const StepResult result = stepper.step(pose, kDt_s);
        trace.forces_n.push_back(result.force_n);
        trace.touched.push_back(result.touched_nodes);
        trace.status |= result.status;
        trace.largest_push_n = std::max(trace.largest_push_n, result.force_n[2]);
        trace.largest_pull_n = std::max(trace.largest_pull_n, -result.force_n[2]);
        for (const auto node : asset.tools[0].nodes) {
            trace.deepest_m =
                std::max(trace.deepest_m, depth_of(asset.tools[0], pose, stepper.positions_m()[node]));
        }
    }
    return trace;
}

/// Most that the force may change in step i: the stiffness of one layer of cells under the whole plate,
/// laterally confined, on the tool's way of a step at its fastest; and, for every node caught or let go in
/// the last steps, a cell's mass brought to that speed or back within a step (it rings in the layers beneath
/// for a few steps).
double explained_change_n(const Trace& trace, std::size_t i, double depth_m) {
    constexpr std::size_t kRinging = 5;
    const double cell_m = 0.1 / kCells;
    const double layer_n_per_m = 22e3 * 0.7 / (1.3 * 0.4) * 0.01 / cell_m;
    const double cell_kg = 1000 * cell_m * cell_m * cell_m;
    const double speed = EIGEN_PI * (depth_m + kClearance_m);
    double changed = 0;
    for (std::size_t k = i; k > 0 && k + kRinging > i; --k) {
        changed +=
            std::abs(static_cast<double>(trace.touched[k]) - static_cast<double>(trace.touched[k - 1]));
    }
    return (layer_n_per_m * kDt_s + changed * cell_kg / kDt_s) * speed;
}

class Touch : public testing::TestWithParam<std::tuple<ToolShape, ToolContact>> {};

TEST_P(Touch, and_leave_never_pulls_never_penetrates_and_jumps_only_by_stiffness_and_caught_inertia) {
    const auto [shape, contact] = GetParam();
    const double depth_m = 0.01;
    const Trace trace = press_and_leave(cube_asset(kCells, shape, contact), depth_m);
    EXPECT_EQ(trace.status, kStepOk);
    EXPECT_GT(trace.largest_push_n, 1);
    EXPECT_LT(trace.largest_pull_n, kPullTolerance * trace.largest_push_n);
    EXPECT_LT(trace.deepest_m, 1e-6);
    EXPECT_EQ(trace.touched.front(), 0u);
    EXPECT_EQ(trace.touched.back(), 0u);
    EXPECT_EQ(trace.forces_n.back(), Vec3{});
    for (std::size_t i = 1; i < trace.forces_n.size(); ++i) {
        EXPECT_LT(std::abs(trace.forces_n[i][2] - trace.forces_n[i - 1][2]),
                  explained_change_n(trace, i, depth_m))
            << "step " << i;
    }
}

std::string name_of(const testing::TestParamInfo<std::tuple<ToolShape, ToolContact>>& tested) {
    return std::string(name_of(std::get<0>(tested.param))) + "_" + name_of(std::get<1>(tested.param));
}

INSTANTIATE_TEST_SUITE_P(
    Tools, Touch,
    testing::Combine(testing::Values(ToolShape::plate, ToolShape::sphere, ToolShape::capsule),
                     testing::Values(ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb)),
    name_of);

TEST(Plate, that_sticks_settles_at_the_force_of_a_bonded_press) {
    const Asset asset = cube_asset(6, ToolShape::plate, ToolContact::sticking);
    Stepper stepper(asset, precise());
    const StepResult result = settle(stepper, asset, {0, 0, -0.01});
    // It takes hold where the nodes are when it comes: at rest, up to what the first contact moves them
    // sideways.
    EXPECT_NEAR(result.force_n[2], kPressedCube_n, 1e-3 * kPressedCube_n);
    EXPECT_EQ(result.touched_nodes, 49u);
}

TEST(Plate, without_friction_settles_lower_than_one_that_sticks_and_lets_the_top_spread) {
    const Asset asset = cube_asset(6, ToolShape::plate, ToolContact::frictionless);
    Stepper stepper(asset, precise());
    const StepResult result = settle(stepper, asset, {0, 0, -0.01});
    EXPECT_EQ(result.touched_nodes, 49u);
    EXPECT_LT(result.force_n[2], 0.98 * kPressedCube_n);
    EXPECT_GT(result.force_n[2], 22e3 * 0.1 * 0.1 * 0.1);  // more than a bar that is free everywhere
    EXPECT_NEAR(result.force_n[0], 0, 1e-9);
    EXPECT_NEAR(result.force_n[1], 0, 1e-9);
    double widest = 0;
    for (const auto node : asset.tools[0].nodes) {
        EXPECT_NEAR(stepper.positions_m()[node].z(), 0.09, 1e-9);
        widest = std::max(widest, stepper.positions_m()[node].x());
    }
    EXPECT_GT(widest, 0.1005);
}

TEST(Plate, dragged_sideways_pulls_along_only_where_it_sticks) {
    for (const ToolContact contact : {ToolContact::sticking, ToolContact::frictionless}) {
        const Asset asset = cube_asset(4, ToolShape::plate, contact);
        Stepper stepper(asset, precise());
        (void)settle(stepper, asset, {0, 0, -0.01}, 50, 50);
        StepResult result;
        for (int i = 1; i <= 100; ++i)
            result = stepper.step(moved(asset, {0.01 * std::min(1.0, i / 50.0), 0, -0.01}), 20e-3);
        if (contact == ToolContact::sticking) {
            EXPECT_LT(result.force_n[0], -2);
        } else {
            EXPECT_NEAR(result.force_n[0], 0, 1e-9);
        }
    }
}

TEST(Plate, with_edges_touches_only_what_lies_before_its_face) {
    Asset asset = cube_asset(6, ToolShape::plate, ToolContact::frictionless);
    asset.tools[0].half_extents_m = {0.02, 0.02};  // 3 x 3 of the 7 x 7 nodes, 1/60 m apart
    Stepper stepper(asset, precise());
    StepResult result = settle(stepper, asset, {0, 0, -0.01}, 50, 50);
    EXPECT_EQ(result.status, kStepOk);
    EXPECT_EQ(result.touched_nodes, 9u);
    // Slid sideways, it leaves what it passes and does not snatch the nodes that stand beside it, above its
    // face.
    double before = result.force_n[2];
    for (int i = 1; i <= 200; ++i) {
        result = stepper.step(moved(asset, {1e-4 * i, 0, -0.01}), 1e-3);
        EXPECT_LT(result.force_n[2], 1.2 * before) << "step " << i;
    }
    EXPECT_LT(result.touched_nodes, 9u);
}

TEST(Plate, turned_upside_down_pushes_up) {
    // The cube hangs from a ceiling; the plate comes from below, its face up.
    Asset asset = asset_of(kuhn_cube(4), at_height(0.1));
    ToolSet tool;
    tool.name = "lift";
    tool.contact = ToolContact::sticking;
    tool.rest_position_m = {0.05, 0.05, 0};
    tool.rest_orientation_wxyz = {0, 1, 0, 0};
    tool.nodes = free_nodes(asset, at_height(0));
    asset.tools = {tool};
    Stepper stepper(asset, precise());
    const StepResult result = settle(stepper, asset, {0, 0, 0.01}, 50, 50);
    EXPECT_EQ(result.touched_nodes, 25u);
    EXPECT_LT(result.force_n[2], -20);
}

TEST(Sphere, without_friction_settles_with_its_nodes_on_the_surface) {
    const Asset asset = cube_asset(8, ToolShape::sphere, ToolContact::frictionless);
    Stepper stepper(asset, precise());
    const Vec3 move{0.003, -0.001, -0.012};
    const StepResult result = settle(stepper, asset, move, 100, 200);
    EXPECT_GE(result.touched_nodes, 3u);
    const Pose pose = moved(asset, move);
    const Vec centre(pose.position_m[0], pose.position_m[1], pose.position_m[2]);
    std::uint32_t on_surface = 0;
    for (const auto node : asset.tools[0].nodes) {
        const double distance = (stepper.positions_m()[node] - centre).norm();
        EXPECT_GT(distance, asset.tools[0].radius_m - 1e-8);
        on_surface += distance < asset.tools[0].radius_m + 1e-8 ? 1 : 0;
    }
    EXPECT_EQ(on_surface, result.touched_nodes);
}

TEST(Contact, whose_set_does_not_settle_in_the_passes_it_has_says_so) {
    const Asset asset = cube_asset(6, ToolShape::sphere, ToolContact::sticking);
    SimulationConfig config;
    config.max_contact_passes = 1;
    Stepper stepper(asset, config);
    EXPECT_EQ(stepper.step(moved(asset, {0, 0, -0.001}), 1e-3).status, kStepContactCap);
}

}  // namespace
}  // namespace knead::test
