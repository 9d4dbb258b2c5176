// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "stability/contact_runs.h"

namespace knead::test {
namespace {

constexpr std::uint32_t kCells = 4;
constexpr double kDtS = 1e-3;
constexpr int kSteps = 240;

/// Press in from 1 mm above, slide, turn, lift off, stay away.
std::vector<Pose> press_slide_turn_lift(const std::vector<Pose>& rest, double time_s) {
    const double down = ramp(time_s, 0, 0.07);
    const double aside = ramp(time_s, 0.06, 0.12);
    const double turned = ramp(time_s, 0.11, 0.17);
    const double up = ramp(time_s, 0.16, 0.22);
    const Vec3 way{0.01 * aside, 0.004 * aside, 0.001 - 0.011 * down + 0.02 * up};
    const Eigen::AngleAxisd turn(0.3 * turned, Eigen::Vector3d(0.1, 0.1, 1).normalized());
    return {moved(rest[0], way, turn)};
}

// A slipping node on a curved tool moves in one tangent plane during a step: 0.2 mm there is 0.7 micrometres off
// a radius of 30 mm.
constexpr double kOffSurfaceM = 2e-6;

struct Touch {
    ToolShape shape;
    ToolContact contact;
};

std::string name_of(const Touch& touch) {
    const char* const shape = touch.shape == ToolShape::plate    ? "plate"
                              : touch.shape == ToolShape::sphere ? "sphere"
                                                                 : "capsule";
    const char* const contact = touch.contact == ToolContact::sticking       ? "sticking"
                                : touch.contact == ToolContact::frictionless ? "frictionless"
                                                                             : "coulomb";
    return std::string(shape) + "_" + contact;
}

ContactScene touched_cube(const Touch& touch) {
    Asset asset = scenario_cube(kCells);
    asset.tools = {tool_above(asset, touch.shape, touch.contact)};
    return scene_of(asset);
}

class ContactAgainstReference : public testing::TestWithParam<Touch> {};

/// Double precision and solved to the end: what is left is the method.
SimulationConfig exact() {
    SimulationConfig config;
    config.arithmetic = Arithmetic::float64;
    config.force_tolerance = 1e-8;
    config.max_contact_passes = 200;
    return config;
}

TEST_P(ContactAgainstReference, Force_torque_and_touched_nodes_are_those_of_the_exact_steps) {
    const ContactScene scene = touched_cube(GetParam());
    const Record run = run_runtime(scene, press_slide_turn_lift, kDtS, kSteps);
    const Record linearised = run_reference(scene, press_slide_turn_lift, kDtS, kSteps, Oracle::linearised);
    const Record converged = run_reference(scene, press_slide_turn_lift, kDtS, kSteps, Oracle::converged);
    const Difference a = difference(run, linearised, 0);
    const Difference b = difference(run, converged, 0);
    std::printf("%s, linearised: %s\n", name_of(GetParam()).c_str(), text(a).c_str());
    std::printf("%s, converged:  %s\n", name_of(GetParam()).c_str(), text(b).c_str());
    EXPECT_EQ(run.status, kStepOk);
    EXPECT_LT(run.farthest_touch_m, kOffSurfaceM);
}

TEST_P(ContactAgainstReference, Solved_to_the_end_the_steps_are_the_linearised_ones) {
    const ContactScene scene = touched_cube(GetParam());
    const Record run = run_runtime(scene, press_slide_turn_lift, kDtS, kSteps, exact());
    const Record truth = run_reference(scene, press_slide_turn_lift, kDtS, kSteps, Oracle::linearised);
    const Difference d = difference(run, truth, 0, truth.slid_at);
    std::printf("%s, slid at %d, exact: %s\n", name_of(GetParam()).c_str(), truth.slid_at, text(d).c_str());
    EXPECT_EQ(run.status, kStepOk);
}

std::vector<Touch> touches() {
    std::vector<Touch> result;
    for (const ToolShape shape : {ToolShape::plate, ToolShape::sphere, ToolShape::capsule})
        for (const ToolContact contact :
             {ToolContact::frictionless, ToolContact::sticking, ToolContact::coulomb})
            result.push_back({shape, contact});
    return result;
}

INSTANTIATE_TEST_SUITE_P(Tool, ContactAgainstReference, testing::ValuesIn(touches()),
                         [](const auto& touch) { return name_of(touch.param); });

/// Two plates close on the cube from both sides, go up together, and open again.
std::vector<Pose> pinch(const std::vector<Pose>& rest, double time_s) {
    const double in_m = 0.006 * (ramp(time_s, 0, 0.06) - 1.5 * ramp(time_s, 0.14, 0.2)) - 0.0005;
    const double up_m = 0.004 * ramp(time_s, 0.06, 0.14);
    const Eigen::AngleAxisd none(0, Eigen::Vector3d::UnitZ());
    return {moved(rest[0], {in_m, 0, up_m}, none), moved(rest[1], {-in_m, 0, up_m}, none)};
}

ToolSet plate_beside(const Asset& asset, double x_m, ToolContact contact) {
    ToolSet tool = tool_above(asset, ToolShape::plate, contact);
    const double side = x_m > kCubeSideM / 2 ? 1 : -1;
    tool.name = x_m > kCubeSideM / 2 ? "right" : "left";
    tool.rest_position_m = {x_m, kCubeSideM / 2, kCubeSideM / 2};
    tool.rest_orientation_wxyz = {std::sqrt(0.5), 0, side * std::sqrt(0.5), 0};  // looks at the cube
    tool.nodes = nodes_on(asset, 0, x_m);
    return tool;
}

TEST(ContactAgainstReferenceOfTwoTools, Pinched_cube_gives_each_plate_the_force_of_the_exact_steps) {
    for (const ToolContact contact : {ToolContact::frictionless, ToolContact::sticking, ToolContact::coulomb}) {
        Asset asset = scenario_cube(kCells);
        asset.tools = {plate_beside(asset, 0, contact), plate_beside(asset, kCubeSideM, contact)};
        const ContactScene scene = scene_of(asset);
        const Record run = run_runtime(scene, pinch, kDtS, kSteps);
        const Record linearised = run_reference(scene, pinch, kDtS, kSteps, Oracle::linearised);
        const Record converged = run_reference(scene, pinch, kDtS, kSteps, Oracle::converged);
        EXPECT_EQ(run.status, kStepOk);
        for (const std::size_t tool : {0, 1}) {
            const Difference a = difference(run, linearised, tool);
            const Difference b = difference(run, converged, tool);
            std::printf("pinch %d, tool %zu, slid at %d, linearised: %s\n", int(contact), tool, linearised.slid_at, text(a).c_str());
            std::printf("pinch %d, tool %zu, converged:  %s\n", int(contact), tool, text(b).c_str());
        }
    }
}

}  // namespace
}  // namespace knead::test
