// SPDX-License-Identifier: Apache-2.0
// The passivity observer and controller: the count by hand, the controller against a sampled wall solved
// exactly.
#include "knead/haptics/passivity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "knead/haptics/safety/norm_limit.h"
#include "knead/haptics/status.h"
#include "unit/haptics/virtual_wall.h"

namespace knead::test {
namespace {

constexpr double kPeriod = 1e-3;
constexpr double kFull_n = 3.3;
constexpr double kRounding_j = 1e-15;  ///< of sums of a few millijoules

PassivityLimits observing() {
    PassivityLimits limits;
    limits.max_damping = 0;
    return limits;
}

TEST(PassivityObserver, Held_force_and_motion_and_count_the_work_of_the_hand) {
    PassivityController controller({}, kFull_n);
    controller.observe({1, 2, 0}, {-2e-3, 0, 5}, kPeriod);  // against the force: the hand gives
    EXPECT_NEAR(controller.absorbed_j(), 2e-3, kRounding_j);
    controller.observe({1, 2, 0}, {1e-3, 1e-3, 0}, kPeriod);
    EXPECT_NEAR(controller.absorbed_j(), -1e-3, kRounding_j);
    EXPECT_NEAR(controller.energy_j(), -1e-3, kRounding_j);
}

TEST(PassivityObserver, Count_and_is_the_energy_of_the_exactly_solved_mass) {
    VirtualWall wall;
    PassivityController controller(observing(), kFull_n);
    double held = 0;
    double last = wall.x_m;
    for (int tick = 0; tick < 1000; ++tick) {
        controller.observe({held, 0, 0}, {wall.x_m - last, 0, 0}, kPeriod);
        ASSERT_NEAR(controller.absorbed_j(), -wall.given_j, 1e-12);
        last = wall.x_m;
        held = wall.wish_n();
        wall.move(held);
    }
}

TEST(PassivityController, Object_that_takes_energy_and_is_left_alone) {
    PassivityController controller({}, kFull_n);
    for (int tick = 0; tick < 100; ++tick) {
        controller.observe({1, 0, 0}, {-1e-4, 0, 0}, kPeriod);
        std::uint32_t status = 0;
        EXPECT_EQ(controller.damp({1, 0, 0}, 1, kPeriod, status), (Vec3{1, 0, 0}));
        EXPECT_EQ(status, kHapticOk);
    }
}

TEST(PassivityController, Energy_out_of_nothing_and_is_damped_as_far_as_needed_along_the_motion) {
    PassivityLimits limits;
    limits.max_damping = 1e3;
    PassivityController controller(limits, kFull_n);
    controller.observe({1, 1, 0}, {1e-3, 0, 0}, kPeriod);  // gave 1 mJ at 1 m/s
    std::uint32_t status = 0;
    const Vec3 force = controller.damp({1, 1, 0}, std::sqrt(2.0), kPeriod, status);
    EXPECT_EQ(status, kHapticPassivity);
    // 1 mJ back and nothing given in the next period, but for the free 0.2 mJ: 0.8 mJ over 1 mm against the
    // motion.
    EXPECT_NEAR(force[0], -0.8, 1e-12);
    EXPECT_EQ(force[1], 1);
    controller.observe(force, {1e-3, 0, 0}, kPeriod);
    EXPECT_NEAR(controller.energy_j(), -limits.free_energy_j, kRounding_j);
}

TEST(PassivityController, Damper_and_is_never_stronger_than_allowed) {
    PassivityController controller({}, kFull_n);
    controller.observe({3, 0, 0}, {1e-3, 0, 0}, kPeriod);
    std::uint32_t status = 0;
    EXPECT_NEAR(controller.damp({3, 0, 0}, 3, kPeriod, status)[0], 3 - 5 * 1, 1e-12);
    EXPECT_EQ(status, kHapticPassivity);
}

TEST(PassivityController, Hand_at_rest_and_nothing_can_be_taken_out) {
    PassivityController controller({}, kFull_n);
    controller.observe({3, 0, 0}, {1e-3, 0, 0}, kPeriod);
    for (int tick = 0; tick < 10; ++tick)  // the window of motion
        controller.observe({3, 0, 0}, {}, kPeriod);
    std::uint32_t status = 0;
    EXPECT_EQ(controller.damp({3, 0, 0}, 3, kPeriod, status), (Vec3{3, 0, 0}));
    EXPECT_EQ(status, kHapticOk);
    EXPECT_NEAR(controller.energy_j(), -3e-3, kRounding_j);  // the debt is kept
}

TEST(PassivityController, Debt_and_is_bounded) {
    PassivityController controller({}, kFull_n);
    for (int tick = 0; tick < 1000; ++tick)
        controller.observe({3, 0, 0}, {1e-3, 0, 0}, kPeriod);
    EXPECT_EQ(controller.energy_j(), -0.05);
    EXPECT_NEAR(controller.absorbed_j(), -3, 1e-9);
}

TEST(PassivityController, Long_passive_past_and_pays_for_no_more_than_a_spring_can_hold) {
    PassivityController controller({}, kFull_n);
    std::uint32_t status = 0;
    for (int tick = 0; tick < 10000; ++tick) {  // sliding with friction: 10 J
        controller.observe({1, 0, 0}, {-1e-3, 0, 0}, kPeriod);
        (void)controller.damp({1, 0, 0}, 1, kPeriod, status);
    }
    EXPECT_NEAR(controller.energy_j(), 1.0 / (2 * 50), kRounding_j);
    (void)controller.damp({1, 0, 0}, 1e300, kPeriod, status);
    EXPECT_NEAR(controller.energy_j(), 0.01, kRounding_j);
    controller.observe({3.3, 0, 0}, {-1, 0, 0}, kPeriod);
    (void)controller.damp({3.3, 0, 0}, 1e300, kPeriod, status);
    EXPECT_NEAR(controller.energy_j(), 3.3 * 0.05, kRounding_j);
}

TEST(PassivityController, No_force_and_forgets_stock_keeps_debt_makes_no_force) {
    PassivityController controller({}, kFull_n);
    std::uint32_t status = 0;
    controller.observe({1, 0, 0}, {-1e-3, 0, 0}, kPeriod);
    EXPECT_EQ(controller.damp({}, 0, kPeriod, status), Vec3{});
    EXPECT_EQ(controller.energy_j(), 0);
    controller.observe({1, 0, 0}, {2e-3, 0, 0}, kPeriod);
    EXPECT_EQ(controller.damp({}, 0, kPeriod, status), Vec3{});
    EXPECT_NEAR(controller.energy_j(), -2e-3, kRounding_j);
    EXPECT_EQ(status, kHapticOk);
}

TEST(PassivityController, Debt_after_a_restart_and_fades_the_force_until_it_is_paid) {
    PassivityController controller({}, kFull_n);
    EXPECT_EQ(controller.share(1), 1);                     // a hand at rest owes nothing
    controller.observe({1, 0, 0}, {2e-4, 0, 0}, kPeriod);  // 0.2 mJ out: half of twice the free energy
    EXPECT_NEAR(controller.share(1), 0.5, 1e-12);
    controller.observe({1, 0, 0}, {1e-2, 0, 0}, kPeriod);
    EXPECT_EQ(controller.share(1), PassivityController::kLeast);
    controller.observe({1, 0, 0}, {-1.02e-2, 0, 0}, kPeriod);  // and in again
    EXPECT_NEAR(controller.share(1), 1, 1e-12);
}

TEST(PassivityController, Object_without_force_and_the_next_contact_is_whole) {
    PassivityController controller({}, kFull_n);
    controller.observe({1, 0, 0}, {4e-4, 0, 0}, kPeriod);
    EXPECT_LT(controller.share(1), 1);
    EXPECT_EQ(controller.share(0), 1);
    EXPECT_EQ(controller.share(1), 1);
    controller.reset();
    controller.observe({1, 0, 0}, {4e-4, 0, 0}, kPeriod);
    EXPECT_LT(controller.share(1), 1);
}

TEST(PassivityController, Without_free_energy_or_only_observing_and_the_share_is_the_least_or_whole) {
    PassivityLimits limits;
    limits.free_energy_j = 0;
    PassivityController strict(limits, kFull_n);
    EXPECT_EQ(strict.share(1), 1);
    strict.observe({1, 0, 0}, {1e-9, 0, 0}, kPeriod);
    EXPECT_EQ(strict.share(1), PassivityController::kLeast);
    PassivityController observer(observing(), kFull_n);
    observer.observe({1, 0, 0}, {1e-2, 0, 0}, kPeriod);
    EXPECT_EQ(observer.share(1), 1);
}

TEST(PassivityController, Slow_motion_through_an_encoder_and_is_damped_steadily) {
    PassivityLimits limits;
    limits.max_damping = 1e-3;  // too weak to change anything: only the velocity counts here
    PassivityController controller(limits, 1e-3);
    constexpr double kSpeed =
        0.011;  // 5 periods for each count of 0.055 mm; from one sample: 0.055 or nothing
    for (int tick = 0; tick < 40; ++tick) {
        controller.observe({3, 0, 0}, {tick % 5 == 4 ? 5.5e-5 : 0, 0, 0}, kPeriod);
        if (tick < 10) continue;
        std::uint32_t status = 0;
        const double speed = (3 - controller.damp({3, 0, 0}, 3, kPeriod, status)[0]) / limits.max_damping;
        EXPECT_GT(speed, kSpeed / 2);
        EXPECT_LT(speed, kSpeed * 2);
    }
}

TEST(PassivityController, Two_samples_at_once_and_are_no_infinite_speed) {
    PassivityController controller({}, kFull_n);
    controller.observe({3, 0, 0}, {1e-3, 0, 0}, kPeriod);
    controller.observe({3, 0, 0}, {1e-3, 0, 0}, 1e-300);
    std::uint32_t status = 0;
    const Vec3 force = controller.damp({3, 0, 0}, 3, kPeriod, status);
    // 2 mm in 1 ms; 6 mJ gone and 6 mJ to come, 0.2 mJ free: 11.8 mJ over 2 mm against the motion.
    EXPECT_NEAR(force[0], 3 - 5.9, 1e-9);
}

/// Largest energy that a wall gave away in 10 s, J, by true motion.
double given_by(VirtualWall wall, const PassivityLimits& limits) {
    PassivityController controller(limits, kFull_n);
    double held = 0;
    double last = wall.seen_m();
    double most = 0;
    for (int tick = 0; tick < 10000; ++tick) {
        const double seen = wall.seen_m();
        const double wish = wall.wish_n();
        controller.observe({held, 0, 0}, {seen - last, 0, 0}, wall.period_s);
        std::uint32_t status = 0;
        const Vec3 force = controller.damp(limit_norm({wish, 0, 0}, kFull_n), wish, wall.period_s, status);
        held = limit_norm(force, kFull_n)[0];
        last = seen;
        wall.move(held);
        most = std::max(most, wall.given_j);
    }
    return most;
}

/// From where on a sampled wall is active on this mass: friction = stiffness * period / 2.
double passive_border_n_per_m(const VirtualWall& wall) {
    return 2 * wall.friction_n_s_per_m / wall.period_s;
}

TEST(PassivityController, Wall_beyond_the_passive_stiffness_and_gives_nothing_away) {
    for (const double times : {2.0, 4.0, 10.0, 20.0, 50.0}) {
        VirtualWall wall;
        wall.stiffness_n_per_m = times * passive_border_n_per_m(wall);
        const PassivityLimits limits;
        // The free energy, and what one prediction over a period can be wrong by (the spring's force changes
        // within it): below 1 mJ in all these cases, a fortieth of what comes out uncontrolled.
        const double allowed_j = limits.free_energy_j + 6e-4;
        EXPECT_LT(given_by(wall, limits), allowed_j) << times;
        EXPECT_GT(given_by(wall, observing()), 10 * allowed_j) << times;
    }
}

TEST(PassivityController, Wall_seen_through_an_encoder_and_gives_nothing_away) {
    VirtualWall wall;
    wall.quantum_m = 5.5e-5;
    for (const double stiffness : {400.0, 1000.0, 2000.0}) {
        wall.stiffness_n_per_m = stiffness;
        // Of the true motion, of which the observer knows the counts: full force times a count beside the
        // above.
        const double allowed_j = PassivityLimits{}.free_energy_j + kFull_n * wall.quantum_m + 6e-4;
        EXPECT_LT(given_by(wall, {}), allowed_j) << stiffness;
        EXPECT_GT(given_by(wall, observing()), 10 * allowed_j) << stiffness;
    }
}

TEST(PassivityController, Passive_wall_and_the_controller_stays_away) {
    VirtualWall wall;
    wall.friction_n_s_per_m = 2;  // far beyond stiffness * period / 2
    wall.stiffness_n_per_m = 400;
    PassivityController controller({}, kFull_n);
    double held = 0;
    double last = wall.x_m;
    for (int tick = 0; tick < 10000; ++tick) {
        controller.observe({held, 0, 0}, {wall.x_m - last, 0, 0}, kPeriod);
        std::uint32_t status = 0;
        held = controller.damp({wall.wish_n(), 0, 0}, wall.wish_n(), kPeriod, status)[0];
        ASSERT_EQ(status, kHapticOk) << tick;
        last = wall.x_m;
        wall.move(held);
    }
    EXPECT_NEAR(held, -wall.hand_n, 1e-3);
}

}  // namespace
}  // namespace knead::test
