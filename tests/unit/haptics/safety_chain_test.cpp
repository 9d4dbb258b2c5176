// SPDX-License-Identifier: Apache-2.0
// The safety chain as a whole: what reaches the hand when something goes wrong, and when nothing does.
#include "knead/haptics/safety.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <type_traits>

#include "unit/haptics/virtual_wall.h"

namespace knead::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kPeriod = 1e-3;
constexpr double kRounding = 1e-9;  ///< of a thousand sums of numbers around one

static_assert(noexcept(std::declval<SafetyChain&>().apply({})));
static_assert(std::is_trivially_copyable_v<SafetyChain>);  // so it owns nothing and cannot allocate in a copy

double length(const Vec3& v) {
    return std::hypot(v[0], v[1], v[2]);
}

SafetyInput wish(double force_n, double x_m = 0) {
    SafetyInput input;
    input.force_n = {0, 0, force_n};
    input.pose.position_m = {x_m, 0, 0};
    input.dt_s = kPeriod;
    return input;
}

SafetyChain chain_of(const SafetyConfig& config = {}) {
    return SafetyChain::create(config).value();
}

/// Engaged, the ramp over, pushing as told.
SafetyChain engaged(const SafetyInput& input, const SafetyConfig& config = {}) {
    SafetyChain chain = chain_of(config);
    SafeForce safe;
    for (int tick = 0; tick < 10000; ++tick)
        safe = chain.apply(input);
    EXPECT_EQ(safe.status & kHapticRamping, 0U);
    return chain;
}

TEST(SafetyChain, Small_steady_force_after_the_ramp_and_is_unchanged) {
    SafetyInput input = wish(2);
    input.torque_nm = {0.1, 0, 0};
    SafetyChain chain = engaged(input);
    const SafeForce safe = chain.apply(input);
    EXPECT_EQ(safe.force_n, input.force_n);
    EXPECT_EQ(safe.torque_nm, input.torque_nm);
    EXPECT_EQ(safe.status, kHapticOk);
}

TEST(SafetyChain, Too_large_force_and_torque_and_are_shortened_to_the_limits) {
    SafetyInput input = wish(0);
    input.force_n = {3e300, 0, 4e300};
    input.torque_nm = {0, -100, 0};
    SafetyChain chain = engaged(input);
    const SafeForce safe = chain.apply(input);
    EXPECT_NEAR(safe.force_n[0], 3.3 * 0.6, kRounding);
    EXPECT_NEAR(safe.force_n[2], 3.3 * 0.8, kRounding);
    EXPECT_NEAR(safe.torque_nm[1], -0.15, kRounding);
    EXPECT_LE(length(safe.force_n), 3.3);
    EXPECT_LE(length(safe.torque_nm), 0.15);
    EXPECT_EQ(safe.status, kHapticSaturated);
}

TEST(SafetyChain, Device_without_torque_and_gets_none_and_hears_nothing_of_it) {
    SafetyConfig config;
    config.max_torque_nm = 0;
    SafetyInput input = wish(1);
    input.torque_nm = {1, 2, 3};
    SafetyChain chain = engaged(input, config);
    const SafeForce safe = chain.apply(input);
    EXPECT_EQ(safe.torque_nm, Vec3{});
    EXPECT_EQ(safe.status, kHapticOk);
}

TEST(SafetyChain, Engaging_in_an_object_and_rises_from_zero_at_the_ramp_s_rate) {
    SafetyChain chain = chain_of();
    for (int tick = 0; tick < 330; ++tick) {
        const SafeForce safe = chain.apply(wish(100));
        EXPECT_NEAR(length(safe.force_n), 10 * kPeriod * tick, kRounding);
        EXPECT_TRUE(safe.status & kHapticRamping);
    }
    (void)chain.apply(wish(100));
    EXPECT_FALSE(chain.apply(wish(100)).status & kHapticRamping);
}

TEST(SafetyChain, Sudden_contact_and_rises_by_the_slew_limit) {
    SafetyChain chain = engaged(wish(0));
    for (const double expected : {1.0, 2.0, 3.0, 3.3, 3.3}) {
        const SafeForce safe = chain.apply(wish(5));
        EXPECT_NEAR(safe.force_n[2], expected, kRounding);
        EXPECT_EQ((safe.status & kHapticSlewLimited) != 0, expected < 3.3);
    }
}

TEST(SafetyChain, Reversal_of_a_huge_force_and_neither_overshoots_nor_leaves_the_line) {
    SafetyChain chain = engaged(wish(1e300));
    double last = length(chain.apply(wish(1e300)).force_n);
    for (int tick = 0; tick < 7; ++tick) {
        const SafeForce safe = chain.apply(wish(-1e300));
        EXPECT_EQ(safe.force_n[0], 0);
        EXPECT_LE(last - safe.force_n[2], 1 + kRounding);
        EXPECT_GE(safe.force_n[2], -3.3);
        last = safe.force_n[2];
    }
    EXPECT_NEAR(last, -3.3, kRounding);
}

TEST(SafetyChain, Late_period_and_earns_no_larger_step) {
    SafetyChain chain = engaged(wish(0));
    SafetyInput late = wish(3);
    late.dt_s = 4 * kPeriod;
    EXPECT_NEAR(chain.apply(late).force_n[2], 1, kRounding);
}

/// Zero at once with these bits, then back with a ramp.
void expect_restart(const SafetyInput& bad, std::uint32_t bits) {
    SafetyChain chain = engaged(wish(2));
    const SafeForce safe = chain.apply(bad);
    EXPECT_EQ(safe.force_n, Vec3{});
    EXPECT_EQ(safe.torque_nm, Vec3{});
    EXPECT_EQ(safe.status, bits | kHapticRamping);
    for (int tick = 0; tick < 200; ++tick) {
        const SafeForce back = chain.apply(wish(2, bad.pose.position_m[0] == 1 ? 1 : 0));
        ASSERT_NEAR(back.force_n[2], std::min(2.0, 10 * kPeriod * tick), kRounding) << tick;
    }
}

TEST(SafetyChain, Force_that_is_not_finite_and_is_zero_then_ramps) {
    for (const double value : {kNan, kInf, -kInf}) {
        expect_restart(wish(value), kHapticNotFinite);
        SafetyInput torque = wish(2);
        torque.torque_nm = {0, value, 0};
        expect_restart(torque, kHapticNotFinite);
    }
}

TEST(SafetyChain, Bad_pose_and_is_zero_then_ramps) {
    expect_restart(wish(2, kNan), kHapticBadPose);
    expect_restart(wish(2, kInf), kHapticBadPose);
    SafetyInput zero_turn = wish(2);
    zero_turn.pose.orientation_wxyz = {0, 0, 0, 0};
    expect_restart(zero_turn, kHapticBadPose);
}

TEST(SafetyChain, Teleport_by_a_metre_and_is_zero_then_ramps) {
    expect_restart(wish(2, 1), kHapticPoseJump);
}

TEST(SafetyChain, Period_ten_times_too_long_and_is_zero_then_ramps) {
    for (const double dt : {10 * kPeriod, 0.0, -1.0, kNan, kInf, 1e300}) {
        SafetyInput late = wish(2);
        late.dt_s = dt;
        expect_restart(late, kHapticTimeJump);
    }
}

TEST(SafetyChain, Failed_step_and_is_zero_then_ramps) {
    SafetyInput failed = wish(2);
    failed.step_failed = true;
    expect_restart(failed, kHapticStepFailed);
}

TEST(SafetyChain, Everything_wrong_at_once_and_is_all_told) {
    SafetyChain chain = engaged(wish(2));
    SafetyInput input = wish(kNan, kNan);
    input.dt_s = kNan;
    input.sample_age_s = kNan;
    input.model_age_s = kNan;
    input.step_failed = true;
    const SafeForce safe = chain.apply(input);
    EXPECT_EQ(safe.force_n, Vec3{});
    EXPECT_EQ(safe.status, kHapticBadPose | kHapticTimeJump | kHapticNotFinite | kHapticStepFailed |
                               kHapticStaleDevice | kHapticStaleModel | kHapticRamping);
}

using Age = double SafetyInput::*;

/// Data stop coming after the last fresh ones at age 0; the force fades, is zero in time, comes back with a
/// ramp.
void expect_fade(Age age, const Watchdog& watchdog, std::uint32_t bit) {
    SafetyChain chain = engaged(wish(3));
    double last = 3;
    for (int tick = 1; tick <= 100; ++tick) {
        SafetyInput input = wish(3);
        input.*age = tick * kPeriod;
        const SafeForce safe = chain.apply(input);
        const double held_until_s = (tick + 1) * kPeriod;
        const double left =
            (watchdog.zero_after_s - held_until_s) / (watchdog.zero_after_s - watchdog.stale_after_s);
        EXPECT_NEAR(safe.force_n[2], 3 * std::clamp(left, 0.0, 1.0), kRounding) << tick;
        EXPECT_LE(safe.force_n[2], last);
        EXPECT_TRUE(input.*age < Watchdog::kLongestSilence_s || safe.force_n == Vec3{}) << tick;
        const bool on_the_border = std::abs(left - 1) < kRounding;
        EXPECT_TRUE(on_the_border || safe.status == (left < 1 ? bit : kHapticOk)) << tick;
        last = safe.force_n[2];
    }
    for (int tick = 0; tick < 200; ++tick)
        ASSERT_NEAR(chain.apply(wish(3)).force_n[2], 10 * kPeriod * tick, kRounding);
}

TEST(SafetyChain, Simulation_that_stopped_and_fades_to_zero_within_50_ms_and_back_with_a_ramp) {
    expect_fade(&SafetyInput::model_age_s, SafetyConfig{}.model_watchdog, kHapticStaleModel);
}

TEST(SafetyChain, Device_that_stopped_and_fades_to_zero_within_50_ms_and_back_with_a_ramp) {
    expect_fade(&SafetyInput::sample_age_s, SafetyConfig{}.device_watchdog, kHapticStaleDevice);
}

TEST(SafetyChain, Simulation_that_comes_back_half_way_and_goes_on_from_there_with_a_ramp) {
    SafetyChain chain = engaged(wish(3));
    SafetyInput input = wish(3);
    input.model_age_s = 0.0415;  // held until 42.5 ms: half way from 35 to 50
    EXPECT_NEAR(chain.apply(input).force_n[2], 1.5, kRounding);
    for (int tick = 0; tick < 100; ++tick) {
        const SafeForce safe = chain.apply(wish(3));
        EXPECT_NEAR(safe.force_n[2], 1.5 + 10 * kPeriod * tick, kRounding);
        EXPECT_TRUE(safe.status & kHapticRamping);
    }
}

TEST(SafetyChain, Simulation_at_60_Hz_and_is_not_stale) {
    SafetyChain chain = engaged(wish(3));
    for (int tick = 0; tick < 200; ++tick) {
        SafetyInput input = wish(3);
        input.model_age_s = kPeriod * (tick % 17);
        EXPECT_EQ(chain.apply(input).status, kHapticOk);
    }
    SafetyInput one_lost = wish(3);
    one_lost.model_age_s = 2.0 / 60;
    EXPECT_EQ(chain.apply(one_lost).status, kHapticOk);
}

TEST(SafetyChain, Rearmed_and_starts_from_zero_as_if_new) {
    SafetyChain chain = engaged(wish(3));
    chain.rearm();
    SafeForce safe = chain.apply(wish(3, 5));  // another place is no jump
    EXPECT_EQ(safe.force_n, Vec3{});
    EXPECT_EQ(safe.status & ~kHapticSlewLimited, kHapticRamping);
    safe = chain.apply(wish(3, 5));
    EXPECT_NEAR(safe.force_n[2], 10 * kPeriod, kRounding);
}

TEST(SafetyChain, Presets_of_1_N_and_1_kN_and_are_kept_to_the_newton) {
    for (const double limit : {1.0, 1000.0}) {
        SafetyConfig config;
        config.max_force_n = limit;
        config.ramp_n_per_s = limit * 3;
        config.slew_n_per_ms = limit / 3;
        SafetyChain chain = engaged(wish(0), config);
        double largest = 0;
        for (int tick = 0; tick < 100; ++tick)
            largest = std::max(largest, length(chain.apply(wish(1e6)).force_n));
        EXPECT_LE(largest, limit);
        EXPECT_NEAR(largest, limit, limit * kRounding);
    }
}

TEST(SafetyChain, Same_input_and_gives_the_same_bits) {
    SafetyChain a = chain_of();
    SafetyChain b = a;
    for (int tick = 0; tick < 1000; ++tick) {
        const SafetyInput input = wish(4 * std::sin(0.01 * tick), 1e-3 * std::sin(0.1 * tick));
        EXPECT_EQ(a.apply(input).force_n, b.apply(input).force_n);
    }
}

/// A mass falls onto a sampled wall after the ramp; largest energy the wall gave away, J.
double given_by(double stiffness_n_per_m, bool passivity, double* absorbed_j = nullptr) {
    SafetyConfig config;
    config.passivity = passivity;
    VirtualWall wall;
    wall.stiffness_n_per_m = stiffness_n_per_m;
    wall.x_m = 0.001;
    SafetyInput input = wish(0, wall.x_m);
    SafetyChain chain = engaged(input, config);
    double most = 0;
    for (int tick = 0; tick < 10000; ++tick) {
        input.pose.position_m = {wall.x_m, 0, 0};
        input.force_n = {wall.wish_n(), 0, 0};
        wall.move(chain.apply(input).force_n[0]);
        most = std::max(most, wall.given_j);
    }
    input.pose.position_m = {wall.x_m, 0, 0};
    (void)chain.apply(input);
    if (absorbed_j) *absorbed_j = chain.absorbed_j() + wall.given_j;
    return most;
}

TEST(SafetyChain, Wall_beyond_the_passive_stiffness_and_gives_nothing_away) {
    for (const double stiffness : {200.0, 400.0, 1000.0, 2000.0}) {  // passive up to 2 * 0.05 / 1 ms = 100
        double difference = 1;
        // What the slew limit and one prediction can be wrong by beside the free 0.2 mJ.
        EXPECT_LT(given_by(stiffness, true, &difference), 4e-4) << stiffness;
        EXPECT_NEAR(difference, 0, kRounding);  // the chain counts what the mass feels
        EXPECT_GT(given_by(stiffness, false), 1e-2) << stiffness;
    }
}

TEST(SafetyChain, Damper_on_top_of_the_full_force_and_the_limit_has_the_last_word) {
    SafetyConfig config;
    config.slew_n_per_ms = 100;
    SafetyInput input = wish(10);
    SafetyChain chain = engaged(wish(0), config);  // in a contact after a restart it would fade instead
    (void)chain.apply(input);
    input.pose.position_m[2] += 4e-3;  // pushed out: 13 mJ from nowhere
    (void)chain.apply(input);
    EXPECT_NEAR(chain.absorbed_j(), -3.3 * 4e-3, kRounding);
    input.pose.position_m = {4e-3, 0, 4e-3};  // aside: the damper adds more than the full force across it
    const SafeForce safe = chain.apply(input);
    EXPECT_EQ(safe.status, kHapticPassivity | kHapticSaturated);
    EXPECT_LT(safe.force_n[0], -1);
    EXPECT_LE(length(safe.force_n), 3.3);
    EXPECT_GE(length(safe.force_n), 3.3 * (1 - kRounding));
}

TEST(SafetyChain, Restart_and_forgets_debt_and_motion) {
    SafetyInput input = wish(2);
    SafetyChain chain = engaged(input);
    input.pose.position_m[2] += 4e-3;  // 8 mJ from nowhere
    (void)chain.apply(input);
    input.step_failed = true;
    (void)chain.apply(input);
    input.step_failed = false;
    for (int tick = 0; tick < 100; ++tick) {
        input.pose.position_m[0] += 1e-3;
        EXPECT_EQ(chain.apply(input).status & kHapticPassivity, 0U) << tick;
    }
}

TEST(SafetyChain, Force_after_stale_data_and_fades_when_it_gives_what_nobody_paid) {
    SafetyInput input = wish(2);
    SafetyChain chain = engaged(wish(0));
    for (int tick = 0; tick < 10; ++tick)
        (void)chain.apply(input);
    input.model_age_s = 0.04;
    EXPECT_EQ(chain.apply(input).status, kHapticStaleModel);
    input.model_age_s = 0;
    const double left_n = chain.apply(input).force_n[2];
    EXPECT_GT(left_n, 0);
    input.pose.position_m[2] += 1e-3;  // more than twice the free energy
    SafeForce safe;
    for (int tick = 0; tick < 5; ++tick) {
        safe = chain.apply(input);
        EXPECT_TRUE(safe.status & kHapticPassivity);
    }
    EXPECT_LE(safe.force_n[2], 2 * PassivityController::kLeast + kRounding);
}

TEST(SafetyConfig, Number_out_of_range_and_is_refused_by_name) {
    const auto refused = [](const std::function<void(SafetyConfig&)>& change, const std::string& name) {
        SafetyConfig config;
        change(config);
        const auto chain = SafetyChain::create(config);
        ASSERT_FALSE(chain.ok()) << name;
        EXPECT_EQ(chain.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(chain.error().message.find(name), std::string::npos) << chain.error().message;
    };
    for (const double bad : {0.0, -1.0, kNan, kInf, 1e7}) {
        refused([&](SafetyConfig& c) { c.max_force_n = bad; }, "max_force_n");
        refused([&](SafetyConfig& c) { c.slew_n_per_ms = bad; }, "slew_n_per_ms");
        refused([&](SafetyConfig& c) { c.slew_nm_per_ms = bad; }, "slew_nm_per_ms");
        refused([&](SafetyConfig& c) { c.ramp_n_per_s = bad; }, "ramp_n_per_s");
        refused([&](SafetyConfig& c) { c.ramp_nm_per_s = bad; }, "ramp_nm_per_s");
        refused([&](SafetyConfig& c) { c.motion.max_hand_speed_m_per_s = bad; }, "max_hand_speed_m_per_s");
        refused([&](SafetyConfig& c) { c.motion.max_turn_speed_rad_per_s = bad; },
                "max_turn_speed_rad_per_s");
        refused([&](SafetyConfig& c) { c.motion.max_dt_ratio = bad; }, "max_dt_ratio");
        refused([&](SafetyConfig& c) { c.device_watchdog.zero_after_s = bad; },
                "device_watchdog.zero_after_s");
        refused([&](SafetyConfig& c) { c.model_watchdog.stale_after_s = bad; },
                "model_watchdog.stale_after_s");
        refused([&](SafetyConfig& c) { c.force_passivity.resolution = bad; }, "force_passivity.resolution");
        refused([&](SafetyConfig& c) { c.torque_passivity.softest = bad; }, "torque_passivity.softest");
        refused([&](SafetyConfig& c) { c.torque_passivity.travel = bad; }, "torque_passivity.travel");
    }
    for (const double bad : {-1.0, kNan, kInf}) {
        refused([&](SafetyConfig& c) { c.max_torque_nm = bad; }, "max_torque_nm");
        refused([&](SafetyConfig& c) { c.motion.slack_m = bad; }, "slack_m");
        refused([&](SafetyConfig& c) { c.motion.slack_rad = bad; }, "slack_rad");
        refused([&](SafetyConfig& c) { c.force_passivity.max_damping = bad; }, "max_damping");
        refused([&](SafetyConfig& c) { c.force_passivity.max_debt_j = bad; }, "max_debt_j");
        refused([&](SafetyConfig& c) { c.torque_passivity.free_energy_j = bad; }, "free_energy_j");
    }
    refused([](SafetyConfig& c) { c.motion.max_dt_ratio = 0.9; }, "max_dt_ratio");
    refused([](SafetyConfig& c) { c.model_watchdog.zero_after_s = 0.051; }, "model_watchdog.zero_after_s");
    refused([](SafetyConfig& c) { c.device_watchdog = {0.03, 0.02}; }, "device_watchdog.stale_after_s");
}

}  // namespace
}  // namespace knead::test
