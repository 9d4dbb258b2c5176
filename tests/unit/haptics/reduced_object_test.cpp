// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/reduced_object.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace knead::test {
namespace {

constexpr double kObject = 1000, kSpring = 500;  // N/m
constexpr double kExact = 1e-6;                  // of a force, after it has settled

/// An object along z whose unloaded surface is at z = 0; the tool is at `tool_z`.
LocalModel wall(double tool_z, std::uint64_t step = 1, double stiffness = kObject) {
    LocalModel model;
    model.step = step;
    model.origin.position_m = {0, 0, tool_z};
    model.unilateral = true;
    model.radius_m = 0.01;
    if (tool_z >= 0) return model;
    model.touched_nodes = 1;
    model.normal = {0, 0, 1};
    model.force_n = {0, 0, -stiffness * tool_z};
    for (const std::size_t axis : {0u, 1u, 2u}) {
        model.stiffness[7 * axis] = stiffness;
        model.damping[7 * axis] = 2;
        model.mass[7 * axis] = 0.02;
    }
    return model;
}

ReducedObject::Config config(double damping = 2) {
    ReducedObject::Config c;
    c.coupling.stiffness_n_per_m = kSpring;
    c.coupling.damping_n_s_per_m = damping;
    return c;
}

Pose at(double z, double x = 0) {
    return {{x, 0, z}, {1, 0, 0, 0}};
}

/// Force along z after the hand has stayed for a second.
Wrench settle(ReducedObject& object, const Pose& hand, double dt = 1e-3, int ticks = 1000) {
    Wrench wrench;
    for (int i = 0; i < ticks; ++i)
        wrench = object.advance(hand, dt);
    return wrench;
}

TEST(ReducedObject, at_rest_is_two_springs_in_a_row) {
    ReducedObject object(config());
    object.reset(at(-0.003));
    ASSERT_TRUE(object.correct(wall(-0.003), 8e-3));
    const double expected = kObject * kSpring / (kObject + kSpring) * 0.003;
    const Wrench wrench = settle(object, at(-0.003));
    EXPECT_NEAR(wrench.force_n[2], expected, kExact);
    EXPECT_NEAR(object.tool().position_m[2], -expected / kObject, kExact);
    EXPECT_EQ(wrench.torque_nm, Vec3{});
    EXPECT_TRUE(object.in_contact());
}

TEST(ReducedObject, without_a_model_gives_only_the_coupling_to_a_free_proxy) {
    ReducedObject object(config());
    object.reset(at(0));
    EXPECT_NEAR(settle(object, at(0.01)).force_n[2], 0, kExact);
    EXPECT_NEAR(object.tool().position_m[2], 0.01, kExact);
}

TEST(ReducedObject, that_may_leave_never_holds_the_tool_back_and_is_met_again_at_its_surface) {
    ReducedObject object(config());
    object.reset(at(-0.003));
    ASSERT_TRUE(object.correct(wall(-0.003), 8e-3));
    (void)settle(object, at(-0.003));
    EXPECT_NEAR(settle(object, at(0.02)).force_n[2], 0, kExact);
    EXPECT_FALSE(object.in_contact());
    // No result has come since: the surface is remembered.
    const double expected = kObject * kSpring / (kObject + kSpring) * 0.002;
    EXPECT_NEAR(settle(object, at(-0.002)).force_n[2], expected, kExact);
}

TEST(ReducedObject, that_is_bonded_pulls) {
    ReducedObject object(config());
    LocalModel model = wall(-0.003);
    model.unilateral = false;
    object.reset(at(-0.003));
    ASSERT_TRUE(object.correct(model, 8e-3));
    EXPECT_NEAR(settle(object, at(0.003)).force_n[2], -kObject * kSpring / (kObject + kSpring) * 0.003,
                kExact);
}

TEST(ReducedObject, forgets_a_surface_that_a_result_contradicts) {
    ReducedObject object(config());
    object.reset(at(-0.003));
    ASSERT_TRUE(object.correct(wall(-0.003), 8e-3));
    (void)settle(object, at(-0.003));
    LocalModel nothing;  // the tool was at -3 mm and touched nothing
    nothing.step = 2;
    nothing.origin = at(-0.003);
    nothing.unilateral = true;
    ASSERT_TRUE(object.correct(nothing, 8e-3));
    EXPECT_NEAR(settle(object, at(-0.003)).force_n[2], 0, kExact);
}

TEST(ReducedObject, keeps_a_surface_while_the_proxy_is_near_wherever_a_result_looked) {
    ReducedObject object(config());
    object.reset(at(-0.003));
    ASSERT_TRUE(object.correct(wall(-0.003), 8e-3));
    (void)settle(object, at(0.002));
    // The hand was forecast 3 cm above and stayed here.
    ASSERT_TRUE(object.correct(wall(0.03, 2), 8e-3));
    const double expected = kObject * kSpring / (kObject + kSpring) * 0.002;
    EXPECT_NEAR(settle(object, at(-0.002)).force_n[2], expected, kExact);
    // Now it does go there.
    (void)settle(object, at(0.03));
    ASSERT_TRUE(object.correct(wall(0.03, 3), 8e-3));
    EXPECT_NEAR(settle(object, at(-0.002)).force_n[2], 0, kExact);
}

TEST(ReducedObject, found_around_a_moving_proxy_takes_its_momentum_and_adds_none) {
    constexpr double kSpeed = 0.1, kPatch = 0.5, kDt = 1e-3;  // m/s, kg, s
    const ReducedObject::Config c = config(0.5);
    ReducedObject object(c);
    object.reset(at(0.1));
    double hand = 0.1;
    while (hand > -1e-4)
        (void)object.advance(at(hand -= kSpeed * kDt), kDt);
    LocalModel late = wall(-1e-4);
    late.mass[14] = kPatch;
    ASSERT_TRUE(object.correct(late, 8e-3));
    const double before = object.tool().position_m[2];
    (void)object.advance(at(hand), kDt);
    const double speed = (object.tool().position_m[2] - before) / kDt;
    const double common = kSpeed * c.coupling.tool_mass_kg / (c.coupling.tool_mass_kg + kPatch);
    // Forces of at most 0.3 N change it by 0.6 mm/s in the tick.
    EXPECT_NEAR(speed, -common, 1e-3);
}

TEST(ReducedObject, takes_over_a_result_without_a_jump_and_then_by_its_gain) {
    ReducedObject::Config c = config();
    c.correction_gain = 0.2;
    ReducedObject object(c);
    object.reset(at(-0.003));
    constexpr double kPeriod = 8e-3;
    ASSERT_TRUE(object.correct(wall(-0.003), kPeriod));
    const double before = settle(object, at(-0.003)).force_n[2];
    ASSERT_TRUE(object.correct(wall(-0.003, 2, 3 * kObject), kPeriod));
    const double after = kSpring * 3 * kObject / (kSpring + 3 * kObject) * 0.003;
    double last = before, largest = 0;
    for (int i = 0; i < 400; ++i) {
        const double force = object.advance(at(-0.003), 1e-3).force_n[2];
        largest = std::max(largest, std::abs(force - last));
        last = force;
    }
    // A first-order rise with 0.8 per 8 ms goes by 2.8 % in a millisecond; the proxy swings behind it.
    EXPECT_LT(largest, 0.05 * (after - before));
    EXPECT_NEAR(last, after, 1e-3 * after);
}

TEST(ReducedObject, stays_bounded_at_every_period_also_when_contact_comes_and_goes) {
    for (const double dt : {0.25e-3, 1e-3, 4e-3, 20e-3}) {
        for (const double damping : {0.0, 0.5, 50.0}) {
            ReducedObject object(config(damping));
            object.reset(at(0));
            ASSERT_TRUE(object.correct(wall(-0.001, 1, 1e6), 8e-3));
            double largest = 0;
            for (int i = 0; i < 2000; ++i) {
                const double z = 0.003 * std::sin(2 * M_PI * 3 * i * dt);
                largest = std::max(largest, std::abs(object.advance(at(z), dt).force_n[2]));
            }
            // Stretch of the spring at most 6 mm, of the damper at most as fast as the hand (57 mm/s) twice.
            EXPECT_LT(largest, kSpring * 0.006 + 2 * damping * 0.06) << dt << " " << damping;
        }
    }
}

/// A hand on the object alone: mass on a spring and damper towards a wish.
double last_swing(double mass_factor) {
    ReducedObject object(config(0.5));
    object.reset(at(0.001));
    double z = 0.001, v = 0, force = 0, least = 1, most = -1;
    const double mass = 0.15, dt = 1e-3;
    for (int i = 0; i < 2000; ++i) {
        if (i % 8 == 0) {
            // What stands in for the simulation: the surface, as far as the tool is in it.
            LocalModel model =
                wall(std::min(z, object.tool().position_m[2]), 1 + static_cast<std::uint64_t>(i));
            for (double& entry : model.mass)
                entry *= mass_factor;
            (void)object.correct(model, 8e-3);
        }
        v += dt / mass * (300 * (-0.005 - z) - 3 * v + force);
        z += dt * v;
        force = object.advance(at(z), dt).force_n[2];
        if (i < 1700) continue;
        least = std::min(least, z);
        most = std::max(most, z);
    }
    return most - least;
}

TEST(ReducedObject, with_a_mass_three_times_too_large_or_small_lets_a_hand_come_to_rest) {
    for (const double factor : {1.0, 3.0, 0.3})
        EXPECT_LT(last_swing(factor), 2e-5) << factor;  // m; the press is 5 mm
}

TEST(ReducedObject, ignores_a_model_that_is_none_or_not_finite) {
    ReducedObject object(config());
    object.reset(at(-0.003));
    ASSERT_TRUE(object.correct(wall(-0.003), 8e-3));
    const double before = settle(object, at(-0.003)).force_n[2];
    EXPECT_FALSE(object.correct(LocalModel{}, 8e-3));
    LocalModel broken = wall(-0.003, 2);
    broken.mass[7] = std::nan("");
    EXPECT_FALSE(object.correct(broken, 8e-3));
    broken = wall(-0.003, 2);
    broken.force_n[1] = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(object.correct(broken, 8e-3));
    EXPECT_NEAR(settle(object, at(-0.003)).force_n[2], before, kExact);
}

TEST(ReducedObject, from_a_hand_that_is_not_finite_recovers) {
    ReducedObject object(config());
    object.reset(at(0));
    const Wrench wrench = object.advance(at(std::nan("")), 1e-3);
    EXPECT_EQ(wrench.force_n, Vec3{});
    object.reset(at(0));
    EXPECT_NEAR(settle(object, at(0)).force_n[2], 0, kExact);
}

TEST(ReducedObject, with_six_degrees_of_freedom_turns_until_the_torques_agree) {
    ReducedObject::Config c = config();
    c.coupling.rotation_stiffness_nm_per_rad = 0.5;
    c.coupling.rotation_damping_nm_s_per_rad = 0.01;
    LocalModel model = wall(-0.003);
    model.unilateral = false;
    for (const std::size_t axis : {3u, 4u, 5u})
        model.stiffness[7 * axis] = 1.5;  // N m / rad
    ReducedObject object(c);
    object.reset(at(-0.003));
    ASSERT_TRUE(object.correct(model, 8e-3));
    Pose hand = at(-0.003);
    const double angle = 0.1;
    hand.orientation_wxyz = {std::cos(angle / 2), 0, std::sin(angle / 2), 0};
    const Wrench wrench = settle(object, hand);
    EXPECT_NEAR(wrench.torque_nm[1], -0.5 * 1.5 / 2.0 * angle, kExact);
    EXPECT_NEAR(2 * std::atan2(object.tool().orientation_wxyz[2], object.tool().orientation_wxyz[0]),
                angle * 0.5 / 2.0, kExact);
}

TEST(LinearView, behind_a_coupling_has_the_stiffness_of_two_springs_in_a_row) {
    const LinearView view = linear_view(wall(-0.002), kSpring, {0, 0, -0.006}, {0, 0, 2});
    const double series = kObject * kSpring / (kObject + kSpring);
    EXPECT_NEAR(view.stiffness_n_per_m[8], series, 1e-9);
    EXPECT_NEAR(view.stiffness_n_per_m[1], 0, 1e-9);
    EXPECT_NEAR(force_at(view, {0, 0, -0.007})[2], 2 + series * 0.001, 1e-9);
    EXPECT_NEAR(force_at(view, {0.001, 0, -0.006})[0], -series * 0.001, 1e-9);
}

TEST(LinearView, never_pulls_along_the_normal_and_ends_at_its_radius) {
    const LinearView view = linear_view(wall(-0.002));
    EXPECT_EQ(view.stamp, 1u);
    EXPECT_NEAR(force_at(view, {0, 0, 0.005})[2], 0, 1e-12);
    EXPECT_NEAR(force_at(view, {0, 0, -1})[2], kObject * (0.002 + 0.01), 1e-9);
}

}  // namespace
}  // namespace knead::test
