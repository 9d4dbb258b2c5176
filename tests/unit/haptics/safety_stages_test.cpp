// SPDX-License-Identifier: Apache-2.0
// Each stage of the safety chain alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "knead/haptics/safety/engage_ramp.h"
#include "knead/haptics/safety/motion_check.h"
#include "knead/haptics/safety/norm_limit.h"
#include "knead/haptics/safety/slew_limit.h"
#include "knead/haptics/safety/watchdog.h"
#include "knead/haptics/status.h"

namespace knead::test {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
constexpr double kRounding = 1e-12;  ///< of a few operations on numbers around one

long double exact_norm(const Vec3& v) {
    return std::sqrt(static_cast<long double>(v[0]) * v[0] + static_cast<long double>(v[1]) * v[1] +
                     static_cast<long double>(v[2]) * v[2]);
}

TEST(NormLimit, Force_within_the_limit_and_is_unchanged) {
    bool shortened = true;
    EXPECT_EQ(limit_norm({1, -2, 2}, 3.1, &shortened), (Vec3{1, -2, 2}));
    EXPECT_FALSE(shortened);
}

TEST(NormLimit, Force_beyond_the_limit_and_keeps_its_direction) {
    bool shortened = false;
    const Vec3 limited = limit_norm({100, -200, 200}, 3, &shortened);
    EXPECT_TRUE(shortened);
    EXPECT_THAT(limited,
                ElementsAre(DoubleNear(1, kRounding), DoubleNear(-2, kRounding), DoubleNear(2, kRounding)));
}

TEST(NormLimit, Result_of_any_finite_force_and_is_never_above_the_limit) {
    for (const double limit : {0.0, kDenormal, 1e-9, 0.7, 1.0, 3.3, 1000.0}) {
        for (const Vec3& force :
             {Vec3{1e300, 1e300, -1e300}, Vec3{1.7e308, 1.7e308, 1.7e308}, Vec3{3.3, 1e-9, 0},
              Vec3{kDenormal, kDenormal, kDenormal}, Vec3{0.1, 0.2, 0.3}, Vec3{1, 1, 1}}) {
            const Vec3 limited = limit_norm(force, limit);
            EXPECT_LE(exact_norm(limited), limit) << force[0] << " limit " << limit;
            EXPECT_LE(std::hypot(limited[0], limited[1], limited[2]), limit);
        }
    }
}

TEST(NormLimit, Huge_force_and_keeps_its_direction) {
    const Vec3 limited = limit_norm({1e308, 0, 1e308}, std::sqrt(2.0));
    EXPECT_THAT(limited, ElementsAre(DoubleNear(1, kRounding), 0, DoubleNear(1, kRounding)));
}

TEST(NormLimit, Force_that_is_not_finite_and_is_left_for_the_last_stage) {
    EXPECT_TRUE(std::isnan(limit_norm({kNan, 0, 0}, 1)[0]));
    EXPECT_EQ(limit_norm({0, kInf, 0}, 1)[1], kInf);
}

TEST(Norm, Lengths_and_neither_overflow_nor_vanish) {
    EXPECT_DOUBLE_EQ(norm({3e200, 0, 4e200}), 5e200);
    EXPECT_DOUBLE_EQ(norm({0, 3e-200, -4e-200}), 5e-200);
    EXPECT_EQ(norm({0, 0, 0}), 0);
    EXPECT_EQ(norm({kDenormal, 0, 0}), kDenormal);
    EXPECT_EQ(norm({-kInf, 0, 1}), kInf);
    EXPECT_TRUE(std::isnan(norm({kNan, 0, 1})));
}

TEST(SlewLimit, Change_within_the_limit_and_arrives) {
    SlewLimit slew(1000);
    std::uint32_t status = 0;
    EXPECT_EQ(slew.apply({0.5, 0.5, 0}, 1e-3, status), (Vec3{0.5, 0.5, 0}));
    EXPECT_EQ(status, kHapticOk);
}

TEST(SlewLimit, Change_beyond_the_limit_and_goes_straight_there_in_equal_steps) {
    SlewLimit slew(1000);
    const Vec3 wanted{2.7, -3.6, 0};  // 4.5 N away
    for (int step = 1; step <= 4; ++step) {
        std::uint32_t status = 0;
        const Vec3 force = slew.apply(wanted, 1e-3, status);
        EXPECT_THAT(force,
                    ElementsAre(DoubleNear(0.6 * step, kRounding), DoubleNear(-0.8 * step, kRounding), 0));
        EXPECT_EQ(status, kHapticSlewLimited) << step;
    }
    std::uint32_t status = 0;
    EXPECT_EQ(slew.apply(wanted, 1e-3, status), wanted);
    EXPECT_EQ(status, kHapticOk);
}

TEST(SlewLimit, Fall_and_turn_and_are_limited_like_a_rise) {
    SlewLimit slew(1000);
    std::uint32_t status = 0;
    slew.follow({3, 0, 0});
    EXPECT_THAT(slew.apply({0, 0, 0}, 1e-3, status), ElementsAre(DoubleNear(2, kRounding), 0, 0));
    slew.follow({3, 0, 0});
    const Vec3 turned = slew.apply({0, 3, 0}, 1e-3, status);
    EXPECT_NEAR(std::hypot(turned[0] - 3, turned[1]), 1, kRounding);
}

TEST(SlewLimit, Huge_wish_and_moves_by_the_limit) {
    SlewLimit slew(1000);
    std::uint32_t status = 0;
    slew.follow({0, 1, 0});
    const Vec3 force = slew.apply({1.7e308, 0, 0}, 1e-3, status);
    EXPECT_THAT(force, ElementsAre(DoubleNear(1, kRounding), DoubleNear(1, kRounding), 0));
}

TEST(SlewLimit, No_time_and_no_change) {
    SlewLimit slew(1000);
    std::uint32_t status = 0;
    EXPECT_EQ(slew.apply({1, 1, 1}, 0, status), (Vec3{0, 0, 0}));
}

TEST(EngageRamp, Fresh_ramp_and_starts_at_zero_and_rises_steadily) {
    EngageRamp ramp(3, 10);
    for (int tick = 0; tick < 300; ++tick) {
        std::uint32_t status = 0;
        const Vec3 force = ramp.apply({0, 0, 7}, 1e-3, status);
        EXPECT_NEAR(force[2], 0.01 * tick, kRounding * (tick + 1));
        EXPECT_EQ(status, kHapticRamping) << tick;
    }
}

TEST(EngageRamp, Ceiling_at_full_and_the_ramp_is_over) {
    EngageRamp ramp(3, 1000);
    std::uint32_t status = 0;
    for (int tick = 0; tick < 4; ++tick)
        (void)ramp.apply({}, 1e-3, status);
    status = 0;
    EXPECT_EQ(ramp.apply({0, 0, 7}, 1e-3, status),
              (Vec3{0, 0, 7}));  // the limit of the norm is another stage's
    EXPECT_EQ(status, kHapticOk);
}

TEST(EngageRamp, Rearmed_ramp_and_never_rises_by_it) {
    EngageRamp ramp(3, 1000);
    std::uint32_t status = 0;
    ramp.rearm(2);
    EXPECT_EQ(ramp.ceiling(), 0);
    for (int tick = 0; tick < 4; ++tick)
        (void)ramp.apply({}, 1e-3, status);
    ramp.rearm(2);
    EXPECT_EQ(ramp.ceiling(), 2);
    ramp.rearm();
    EXPECT_EQ(ramp.apply({1, 0, 0}, 1e-3, status), (Vec3{0, 0, 0}));
}

TEST(Watchdog, Age_of_the_data_and_fades_in_a_straight_line_to_exact_zero) {
    const Watchdog watchdog{0.02, 0.05};
    EXPECT_EQ(watchdog.share(0), 1);
    EXPECT_EQ(watchdog.share(0.02), 1);
    EXPECT_NEAR(watchdog.share(0.03), 2.0 / 3, kRounding);
    EXPECT_NEAR(watchdog.share(0.035), 0.5, kRounding);
    EXPECT_EQ(watchdog.share(0.05), 0);
    EXPECT_EQ(watchdog.share(1e300), 0);
}

TEST(Watchdog, Age_that_is_no_age_and_is_too_old) {
    const Watchdog watchdog{0.02, 0.05};
    for (const double age : {kNan, kInf, -kInf, -1e-9})
        EXPECT_EQ(watchdog.share(age), 0) << age;
}

TEST(Watchdog, Nothing_between_whole_and_zero_and_steps) {
    const Watchdog watchdog{0.05, 0.05};
    EXPECT_EQ(watchdog.share(0.0499), 1);
    EXPECT_EQ(watchdog.share(0.0501), 0);
}

Pose at(double x, double angle = 0) {
    Pose pose;
    pose.position_m = {x, 0, 0};
    pose.orientation_wxyz = {std::cos(angle / 2), 0, std::sin(angle / 2), 0};
    return pose;
}

constexpr double kPeriod = 1e-3;

Motion observe(MotionCheck& check, const Pose& pose, double dt = kPeriod, double age = 0) {
    return check.observe(pose, dt, kPeriod, age);
}

TEST(MotionCheck, First_pose_and_is_no_motion) {
    MotionCheck check({});
    const Motion motion = observe(check, at(7));
    EXPECT_EQ(motion.status, 0U);
    EXPECT_EQ(motion.moved_m, Vec3{});
    EXPECT_EQ(motion.turned_rad, Vec3{});
}

TEST(MotionCheck, Motion_of_a_hand_and_is_told) {
    MotionCheck check({});
    (void)observe(check, at(0.1, 0.3));
    const Motion motion = observe(check, at(0.1005, 0.31));
    EXPECT_EQ(motion.status, 0U);
    EXPECT_THAT(motion.moved_m, ElementsAre(DoubleNear(5e-4, kRounding), 0, 0));
    EXPECT_THAT(motion.turned_rad, ElementsAre(0, DoubleNear(0.01, kRounding), 0));
}

TEST(MotionCheck, Quaternion_of_the_other_sign_and_is_the_same_rotation) {
    MotionCheck check({});
    (void)observe(check, at(0, 0.3));
    Pose other = at(0, 0.29);
    for (double& part : other.orientation_wxyz)
        part = -part;
    const Motion motion = observe(check, other);
    EXPECT_EQ(motion.status, 0U);
    EXPECT_THAT(motion.turned_rad, ElementsAre(0, DoubleNear(-0.01, kRounding), 0));
}

TEST(MotionCheck, Teleport_and_is_a_pose_jump_once) {
    MotionCheck check({});
    (void)observe(check, at(0));
    const Motion jump = observe(check, at(1));
    EXPECT_EQ(jump.status, kHapticPoseJump);
    EXPECT_EQ(jump.moved_m, Vec3{});
    EXPECT_EQ(observe(check, at(1)).status, 0U);
    EXPECT_EQ(observe(check, at(1e300)).status, kHapticPoseJump);
    EXPECT_EQ(observe(check, at(-1.7e308)).status, kHapticPoseJump);
    EXPECT_EQ(observe(check, at(0, 3)).status, kHapticPoseJump);
}

TEST(MotionCheck, Fastest_hand_and_is_the_border) {
    MotionCheck check({});
    (void)observe(check, at(0));
    EXPECT_EQ(observe(check, at(0.0059)).status, 0U);  // 5 m/s * 1 ms + 1 mm
    EXPECT_EQ(observe(check, at(0.0120)).status, kHapticPoseJump);
    EXPECT_EQ(observe(check, at(0.0120, 0.069)).status, 0U);  // 50 rad/s * 1 ms + 0.02
    EXPECT_EQ(observe(check, at(0.0120, 0.141)).status, kHapticPoseJump);
}

TEST(MotionCheck, Device_that_was_silent_and_may_have_moved_meanwhile) {
    MotionCheck check({});
    (void)observe(check, at(0));
    (void)observe(check, at(0), kPeriod, 0.010);
    EXPECT_EQ(observe(check, at(0.05)).status, 0U);  // 11 ms
    (void)observe(check, at(0.05), kPeriod, 1e9);
    EXPECT_EQ(observe(check, at(0.4)).status, kHapticPoseJump);  // no age allows more than 50 ms
    (void)observe(check, at(0.4), kPeriod, kNan);
    EXPECT_EQ(observe(check, at(0.41)).status, kHapticPoseJump);
}

TEST(MotionCheck, Period_far_from_the_expected_one_and_is_a_time_jump) {
    for (const double dt : {10 * kPeriod, 8.1 * kPeriod, 0.0, -kPeriod, kNan, kInf, -kInf}) {
        MotionCheck check({});
        (void)observe(check, at(0));
        EXPECT_EQ(observe(check, at(0), dt).status, kHapticTimeJump) << dt;
    }
    for (const double dt : {1e-9, kPeriod / 2, 7.9 * kPeriod}) {
        MotionCheck check({});
        (void)observe(check, at(0));
        EXPECT_EQ(observe(check, at(0), dt).status, 0U) << dt;
    }
}

TEST(MotionCheck, Expected_period_out_of_range_and_is_a_time_jump) {
    for (const double expected : {0.0, 1e-6, 0.2, -1e-3, kNan, kInf}) {
        MotionCheck check({});
        EXPECT_EQ(check.observe(at(0), expected, expected, 0).status, kHapticTimeJump) << expected;
    }
}

TEST(MotionCheck, Pose_that_is_none_and_is_bad_and_forgotten) {
    Pose not_unit = at(0);
    not_unit.orientation_wxyz[0] = 1.1;
    Pose nan_turn = at(0);
    nan_turn.orientation_wxyz[3] = kNan;
    for (const Pose& bad : {at(kNan), at(kInf), not_unit, nan_turn}) {
        MotionCheck check({});
        (void)observe(check, at(0));
        EXPECT_EQ(observe(check, bad).status, kHapticBadPose);
        EXPECT_EQ(observe(check, at(3)).status, 0U);  // a first one again
    }
}

}  // namespace
}  // namespace knead::test
