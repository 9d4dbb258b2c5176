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

class ContactAgainstReference : public testing::TestWithParam<Touch> {};

TEST_P(ContactAgainstReference, Forces) {
    Asset asset = scenario_cube(kCells);
    asset.tools = {tool_above(asset, GetParam().shape, GetParam().contact)};
    const ContactScene scene = scene_of(asset);
    const Record run = run_runtime(scene, press_slide_turn_lift, kDtS, kSteps);
    const Record linearised = run_reference(scene, press_slide_turn_lift, kDtS, kSteps, Oracle::linearised);
    const Record converged = run_reference(scene, press_slide_turn_lift, kDtS, kSteps, Oracle::converged);
    const std::string n = name_of(GetParam());
    std::uint32_t status = 0;
    for (auto s : run.status) status |= s;
    std::printf("%s: status %u, farthest %.1e, let slide %zu %zu\n", n.c_str(), status, run.farthest_touch_m,
                linearised.let_slide, converged.let_slide);
    std::printf("%s: linearised: %s\n", n.c_str(), text(difference(run, linearised, 0)).c_str());
    std::printf("%s: converged:  %s\n", n.c_str(), text(difference(run, converged, 0)).c_str());
    std::printf("%s: lin/conv:   %s\n", n.c_str(), text(difference(linearised, converged, 0)).c_str());
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

}  // namespace
}  // namespace knead::test
