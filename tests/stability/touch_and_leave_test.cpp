// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "stability/contact_runs.h"
#include "stability/touch.h"

namespace knead::test {
namespace {

constexpr std::uint32_t kCells = 4;
constexpr double kDtS = 1e-3;
constexpr int kSteps = 300;

/// Twice down, aside and off again, the second time faster than soft matter follows.
std::vector<Pose> tap_twice(const std::vector<Pose>& rest, double time_s) {
    const double slow = ramp(time_s, 0.01, 0.06) - ramp(time_s, 0.08, 0.12);
    const double fast = ramp(time_s, 0.15, 0.175) - ramp(time_s, 0.19, 0.21);
    const double away = ramp(time_s, 0.2, 0.24);  // farther than the body swings
    const Vec3 way{0.006 * ramp(time_s, 0.05, 0.2), 0, 0.002 - 0.012 * slow - 0.01 * fast + 0.03 * away};
    return {moved(rest[0], way, Eigen::AngleAxisd(0, Eigen::Vector3d::UnitZ()))};
}

class TouchAndLeave : public testing::TestWithParam<Touch> {
  protected:
    TouchAndLeave() {
        for (const std::vector<ToolSample>& tools : run_.steps)
            largest_n_ = std::max(largest_n_, tools[0].force_n.norm());
    }
    ContactScene scene_ = touched_cube(GetParam(), kCells);
    Record run_ = run_runtime(scene_, tap_twice, kDtS, kSteps);
    double largest_n_ = 0;
};

// A pull of a node is let go of beyond the solver's own error: a thousandth of the force, all nodes together.
constexpr double kPull = 1e-3;

TEST_P(TouchAndLeave, Never_pulls_and_leaves_no_force_behind) {
    ASSERT_EQ(run_.status, kStepOk);
    ASSERT_GT(largest_n_, 1);
    int touches = 0;
    for (int k = 0; k < kSteps; ++k) {
        const ToolSample& tool = run_.steps[static_cast<std::size_t>(k)][0];
        EXPECT_GE(tool.force_n.z(), -kPull * largest_n_) << "step " << k + 1;
        if (tool.touched.empty()) {
            EXPECT_EQ(tool.force_n.norm(), 0) << "step " << k + 1;
            EXPECT_EQ(tool.torque_n_m.norm(), 0) << "step " << k + 1;
        } else if (k > 0 && run_.steps[static_cast<std::size_t>(k) - 1][0].touched.empty()) {
            ++touches;
        }
    }
    EXPECT_GE(touches, 2);
    EXPECT_TRUE(run_.steps.back()[0].touched.empty());
}

/// Speed of the tool in a step (from 1).
Eigen::Vector3d tool_velocity(int step) {
    const Eigen::Vector3d now = vec(tap_twice({Pose{}}, step * kDtS)[0].position_m);
    const Eigen::Vector3d before = vec(tap_twice({Pose{}}, (step - 1) * kDtS)[0].position_m);
    return Eigen::Vector3d((now - before) / kDtS);
}

/// How much the acceleration that held nodes share with the tool changed since the step before.
double change_of_acceleration(int step) {
    const Eigen::Vector3d now = tool_velocity(step) - tool_velocity(step - 1);
    const Eigen::Vector3d before = tool_velocity(step - 1) - tool_velocity(step - 2);
    return (now - before).norm() / kDtS;
}

double largest_node_mass_kg(const ContactScene& scene) {
    std::vector<double> mass(scene.mesh.nodes_m.size());
    for (std::size_t t = 0; t < scene.mesh.tetrahedra.size(); ++t)
        for (const std::uint32_t n : scene.mesh.tetrahedra[t])
            mass[n] += scene.material.density_kg_per_m3[t] * signed_volume_m3(scene.mesh, t) / 4;
    double largest = 0;
    for (const std::uint32_t n : scene.asset.tools[0].nodes)
        largest = std::max(largest, mass[n]);
    return largest;
}

/// Of the cells under the whole face, if they were all of its stiffest matter and could not give way
/// sideways: what is between the nodes that the tool holds and those that swing freely.
double largest_stiffness_n_per_m(const ContactScene& scene) {
    constexpr double kHeldSideways = 1.35;  // (1 - nu) / ((1 + nu) (1 - 2 nu)) at nu .3
    const auto& e = scene.material.youngs_modulus_pa;
    return kHeldSideways * *std::max_element(e.begin(), e.end()) * kCubeSideM * kCells;
}

/// A node that sticks may be let go of with any force along the surface: no bound for those.
class JumpOfForce : public TouchAndLeave {};

TEST_P(JumpOfForce, Is_no_more_than_stiffness_and_the_inertia_of_the_caught_nodes_explain) {
    const double mass_kg = largest_node_mass_kg(scene_);
    const double stiffness_n_per_m = largest_stiffness_n_per_m(scene_);
    double nearest = 0;
    for (std::size_t k = 1; k < run_.steps.size(); ++k) {
        const ToolSample& before = run_.steps[k - 1][0];
        const ToolSample& now = run_.steps[k][0];
        if (now.touched == before.touched) continue;
        std::vector<std::uint32_t> caught;
        std::set_difference(now.touched.begin(), now.touched.end(), before.touched.begin(),
                            before.touched.end(), std::back_inserter(caught));
        const int step = static_cast<int>(k) + 1;
        const double speed = tool_velocity(step).norm() + run_.speed_m_per_s[k - 1];
        const auto held = static_cast<double>(std::max(now.touched.size(), before.touched.size()));
        const double bound_n = static_cast<double>(caught.size()) * mass_kg * speed / kDtS +
                               stiffness_n_per_m * speed * kDtS +
                               held * mass_kg * change_of_acceleration(step);
        const double jump_n = (now.force_n - before.force_n).norm();
        EXPECT_LT(jump_n, bound_n) << "step " << k + 1 << ", " << caught.size() << " nodes caught";
        nearest = std::max(nearest, jump_n / bound_n);
    }
    RecordProperty("jump_over_bound", testing::PrintToString(nearest));
}

INSTANTIATE_TEST_SUITE_P(Tool, TouchAndLeave, testing::ValuesIn(all_touches()));

std::vector<Touch> not_sticking() {
    std::vector<Touch> result = all_touches();
    std::erase_if(result, [](const Touch& t) { return t.contact == ToolContact::sticking; });
    return result;
}

INSTANTIATE_TEST_SUITE_P(Tool, JumpOfForce, testing::ValuesIn(not_sticking()));

}  // namespace
}  // namespace knead::test
