// SPDX-License-Identifier: Apache-2.0
#include "core/friction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/runtime/dense_body.h"

namespace knead::test {
namespace {

using core::Contact;
using Eigen::AngleAxisd;

constexpr double kTolerance = 1e-5;        ///< relative, of a solve here
constexpr double kCone = 10 * kTolerance;  ///< what DenseBody asks of friction
/// A node that creeps less than this in a step may have any direction: its friction is within kCone anyhow.
constexpr double kCreep_m = 1e-7;
/// Friction that is within kCone of its fixed point may miss the direction of a slip this much longer than
/// the node's own compliance allows for kCone.
constexpr double kDirection = 1e-2;

Asset cube_under_plate(ToolContact contact, double friction = 0) {
    Asset asset = cube_asset(3, ToolShape::plate, contact);
    asset.tools[0].friction_coefficient = friction;
    return asset;
}

/// Presses by 8 mm and then drags by `drag_m` along x, all in a second, and rests half a second.
void press_and_drag(DenseBody& body, double drag_m) {
    for (int i = 1; i * body.dt <= 1.5; ++i) {
        const double t = i * body.dt;
        const double z = -0.008 * std::min(1.0, t / 0.3), x = drag_m * std::clamp((t - 0.3) / 0.7, 0.0, 1.0);
        ASSERT_EQ(body.step({placed(body.rest_frames[0], Vec(x, 0, z))}, kTolerance).revision,
                  Contact::Revision::settled)
            << "step " << i;
    }
}

int slipping(const DenseBody& body) {
    int count = 0;
    for (const auto& constraint : body.constraints)
        count += constraint.held.trace() < 2 ? 1 : 0;
    return count;
}

TEST(CoulombPlate, with_more_friction_than_the_shear_needs_does_as_one_that_sticks) {
    DenseBody coulomb(cube_under_plate(ToolContact::coulomb, 5), 5e-3);
    DenseBody sticking(cube_under_plate(ToolContact::sticking), 5e-3);
    press_and_drag(coulomb, 0.01);
    press_and_drag(sticking, 0.01);
    EXPECT_EQ(slipping(coulomb), 0);
    const Vec force = sticking.contact.load(0).force_n;
    EXPECT_LT(force.x(), -1);
    // Nodes that came with next to no normal force slipped a little then.
    EXPECT_LT((coulomb.contact.load(0).force_n - force).norm(), 5e-3 * force.norm());
}

TEST(CoulombPlate, dragged_far_feels_its_coefficient_times_the_normal_force_against_its_way) {
    for (const double friction : {0.1, 0.3}) {
        DenseBody body(cube_under_plate(ToolContact::coulomb, friction), 2e-3);
        const int steps = 1000;
        for (int i = 1; i <= steps; ++i) {
            const double t = i * body.dt;
            const Vec move(0.04 * std::max(0.0, t - 0.5), 0, -0.008 * std::min(1.0, t / 0.5));
            ASSERT_EQ(body.step({placed(body.rest_frames[0], move)}, kTolerance).revision,
                      Contact::Revision::settled);
        }
        const Vec force = body.contact.load(0).force_n;
        EXPECT_EQ(slipping(body), 16);
        EXPECT_GT(force.z(), 10);
        EXPECT_NEAR(force.x(), -friction * force.z(), 1e-4 * force.z());
        EXPECT_NEAR(force.y(), 0, 1e-2 * friction * force.z());
    }
}

TEST(CoulombPlate, at_every_step_keeps_each_node_in_its_cone_and_slips_against_friction) {
    const double friction = 0.4;
    for (const double dt : {1e-3, 5e-3}) {
        DenseBody body(cube_under_plate(ToolContact::coulomb, friction), dt);
        core::Field before = body.positions;
        Vec tool_before = body.rest_frames[0].position;
        std::vector<bool> held_before(body.model.rest_m.size(), false);
        int slips = 0, sticks = 0;
        for (int i = 1; i * dt <= 1.0; ++i) {
            const double t = i * dt, drag = std::max(0.0, t - 0.2);
            const Vec move(0.02 * std::sin(9 * drag), 0.01 * std::sin(14 * drag),
                           -0.008 * std::min(1.0, t / 0.2));
            const Frame frame = placed(body.rest_frames[0], move);
            ASSERT_EQ(body.step({frame}, kTolerance).revision, Contact::Revision::settled)
                << "dt " << dt << " step " << i;
            for (std::size_t k = 0; k < body.constraints.size(); ++k) {
                const auto& c = body.constraints[k];
                const Vec force = core::force_on_tool(c, body.rows_n[k]);
                const double normal = force.z(), tangential = std::hypot(force.x(), force.y());
                const double slack = 2 * (kCone * friction * normal + body.pull_tolerance_n);
                ASSERT_LE(tangential, friction * normal + slack) << "step " << i;
                if (c.held.trace() > 2) {
                    ++sticks;
                    continue;
                }
                ++slips;
                ASSERT_NEAR(tangential, friction * normal, slack) << "step " << i;
                Vec slip = (body.positions[c.node] - before[c.node]) - (frame.position - tool_before);
                slip.z() = 0;
                const bool came_now = !held_before[c.node];  // it also moved on the way to the plate
                if (came_now || slip.norm() < kCreep_m || normal < 1e-3) continue;
                const double cosine = c.friction_n.dot(slip) / (c.friction_n.norm() * slip.norm());
                ASSERT_LT(cosine, -1 + kDirection) << "step " << i << " slip " << slip.norm();
            }
            std::fill(held_before.begin(), held_before.end(), false);
            for (const auto& c : body.constraints)
                held_before[c.node] = true;
            before = body.positions;
            tool_before = frame.position;
        }
        EXPECT_GT(slips, 100);
        EXPECT_GT(sticks, 100);
    }
}

/// A block that lies on a plate under gravity that is tilted by `slope`.
Asset block_on_a_plate(double friction) {
    Asset asset =
        asset_of(kuhn_box(3, 3, 2, {0.06, 0.06, 0.02}), [](const Point&) { return false; }, {2e5, 0.3, 1000});
    ToolSet tool;
    tool.name = "slope";
    tool.contact = ToolContact::coulomb;
    tool.friction_coefficient = friction;
    tool.rest_orientation_wxyz = {0, 1, 0, 0};  // its face up
    tool.nodes = free_nodes(asset, at_height(0));
    asset.tools = {tool};
    return asset;
}

Vec mean_velocity(const DenseBody& body) {
    Vec sum = Vec::Zero();
    double mass = 0;
    for (std::size_t i = 0; i < body.velocities.size(); ++i) {
        sum += body.model.mass_kg[i] * body.velocities[i];
        mass += body.model.mass_kg[i];
    }
    return sum / mass;
}

TEST(CoulombPlate, as_a_slope_lets_a_block_slide_with_the_analytic_acceleration) {
    const double friction = 0.3, g = 9.81, slope = 0.5;
    DenseBody body(block_on_a_plate(friction), 1e-3);
    body.gravity = g * Vec(std::sin(slope), 0, -std::cos(slope));
    const auto slide = [&](int steps) {
        for (int i = 0; i < steps; ++i)
            (void)body.step({body.rest_frames[0]}, kTolerance);
    };
    slide(200);
    const Vec start = mean_velocity(body);
    slide(200);
    const double acceleration = g * (std::sin(slope) - friction * std::cos(slope));
    EXPECT_EQ(slipping(body), 16);
    EXPECT_NEAR((mean_velocity(body) - start).x(), acceleration * 200 * body.dt, 1e-3 * acceleration);
    EXPECT_NEAR(mean_velocity(body).z(), 0, 1e-4);
}

TEST(CoulombPlate, as_a_slope_less_steep_than_its_cone_keeps_a_block_in_its_place) {
    const double g = 9.81, slope = 0.5;
    DenseBody body(block_on_a_plate(0.9), 1e-3);
    body.gravity = g * Vec(std::sin(slope), 0, -std::cos(slope));
    for (int i = 0; i < 600; ++i)
        (void)body.step({body.rest_frames[0]}, kTolerance);
    EXPECT_LT(mean_velocity(body).norm(), 1e-5);
    const double weight = 0.06 * 0.06 * 0.02 * 1000 * g;
    const Vec force = body.contact.load(0).force_n;  // of the block on the plate: its weight
    EXPECT_LT((force - weight * Vec(std::sin(slope), 0, -std::cos(slope))).norm(), 1e-3 * weight);
}

double torque_of_a_turn(ToolContact contact, double friction, double angle) {
    DenseBody body(cube_under_plate(contact, friction), 5e-3);
    for (int i = 1; i <= 200; ++i) {
        const double press = std::min(1.0, i / 50.0), turn = std::clamp((i - 50) / 50.0, 0.0, 1.0);
        const Frame frame =
            placed(body.rest_frames[0], Vec(0, 0, -0.008 * press), AngleAxisd(turn * angle, Vec::UnitZ()));
        (void)body.step({frame}, kTolerance);
        if (i < 200 || contact != ToolContact::sticking) continue;
        for (const auto& c : body.constraints) {  // carried with the plate
            const Vec arm = body.model.rest_m[c.node] - body.rest_frames[0].position;
            const Vec expected = AngleAxisd(angle, Vec::UnitZ()) * arm;
            // It took hold where the nodes came to it, a little outward of where they rest.
            EXPECT_LT((body.positions[c.node] - frame.position - expected).norm(), 2e-3);
        }
    }
    return body.contact.load(0).torque_n_m.z();
}

TEST(TurnedPlate, twists_the_body_and_feels_a_torque_against_its_turn) {
    const double angle = 0.2;
    const double sticking = torque_of_a_turn(ToolContact::sticking, 0, angle);
    EXPECT_LT(sticking, -0.01);
    EXPECT_NEAR(torque_of_a_turn(ToolContact::sticking, 0, -angle), -sticking, 0.05 * -sticking);
    EXPECT_NEAR(torque_of_a_turn(ToolContact::frictionless, 0, angle), 0, 1e-6);
    const double coulomb = torque_of_a_turn(ToolContact::coulomb, 0.1, angle);
    EXPECT_LT(coulomb, 0.01 * sticking);
    EXPECT_GT(coulomb, 0.9 * sticking);
}

TEST(Friction, that_would_hold_is_kept_and_more_is_cut_to_the_cone) {
    core::Slip slip;
    slip.friction_n = Vec(-1, 0, 0);
    slip.slip_m = Vec(1e-3, 2e-3, 0);
    bool holds = false;
    const Vec free = core::friction_of(slip, 1000, 3, holds);
    EXPECT_TRUE(holds);
    EXPECT_LT((free - Vec(-2, -2, 0)).norm(), 1e-15);
    const Vec cut = core::friction_of(slip, 1000, 1, holds);
    EXPECT_FALSE(holds);
    EXPECT_LT((cut - Vec(-1, -1, 0).normalized()).norm(), 1e-15);
    EXPECT_EQ(core::friction_of(slip, 1000, 0, holds), Vec(Vec::Zero()));
}

}  // namespace
}  // namespace knead::test
