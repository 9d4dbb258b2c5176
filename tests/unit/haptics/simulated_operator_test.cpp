// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/simulated_operator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace knead {
namespace {

using ::testing::HasSubstr;

constexpr double kPeriod = 1e-3;

OperatorConfig quiet() {
    OperatorConfig config;
    config.device_mass_kg = 0.04;
    config.hand_mass_kg = 0.06;
    config.period_s = kPeriod;
    return config;
}

SimulatedOperator made(const OperatorConfig& config) {
    auto result = SimulatedOperator::create(config);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().text());
    return std::move(result).value();
}

/// A hand that has let go: no spring, no damper.
OperatorConfig free_body() {
    OperatorConfig config = quiet();
    config.hand_stiffness_n_per_m = config.hand_damping_n_s_per_m = 0;
    return config;
}

TEST(Simulated_operator, Under_a_constant_force_falls_as_Galilei_says) {
    constexpr double kForce = 0.5, kMass = 0.1;
    constexpr double kRounding = 1e-12;  ///< relative: the motion is exact up to rounding
    SimulatedOperator device = made(free_body());
    (void)device.read();
    device.write({0, 0, -kForce}, {});
    for (int i = 1; i <= 200; ++i) {
        const double t = i * kPeriod, z = -0.5 * kForce / kMass * t * t;
        EXPECT_NEAR(device.read().pose.position_m[2], z, kRounding);
        EXPECT_NEAR(device.energy().port_j, -kForce * z, kRounding);
    }
}

// Oracle: the closed solution of the damped oscillator, which the code never uses.
TEST(Simulated_operator, Let_go_beside_its_wish_swings_as_the_damped_oscillator) {
    constexpr double kMass = 0.1, kStiffness = 400, kDamping = 2, kStart = 0.01;
    constexpr double kRounding = 1e-12;
    OperatorConfig config = quiet();
    config.hand_stiffness_n_per_m = kStiffness;
    config.hand_damping_n_s_per_m = 1.5;
    config.device_damping_n_s_per_m = 0.5;
    // The wish jumps away at 10 ms, which is a time of two targets.
    Pose there;
    there.position_m[0] = kStart;
    config.path = {{0.010, {}}, {0.010, there}};
    SimulatedOperator device = made(config);
    const double decay = kDamping / (2 * kMass), omega = std::sqrt(kStiffness / kMass - decay * decay);
    for (int i = 0; i < 300; ++i) {
        const double t = i * kPeriod - 0.010;
        const double swing =
            std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
        const double x = t < 0 ? 0 : kStart * (1 - swing);
        EXPECT_NEAR(device.read().pose.position_m[0], x, kRounding) << "sample " << i;
        device.write({}, {});
    }
}

TEST(Simulated_operator, Follows_a_moving_wish_with_the_lag_of_its_damping) {
    // In steady motion spring and dampers balance: k lag = device damping * speed.
    constexpr double kSpeed = 0.1, kStiffness = 300, kDamping = 3;
    constexpr double kSettled = 1e-9;  ///< metres: what is left of the start after 3 s
    OperatorConfig config = quiet();
    config.hand_stiffness_n_per_m = kStiffness;
    config.device_damping_n_s_per_m = kDamping;
    Pose far;
    far.position_m = {0, kSpeed * 10, 0};
    config.path = {{0, {}}, {10, far}};
    SimulatedOperator device = made(config);
    for (int i = 0; i < 3000; ++i)
        (void)device.read();
    (void)device.read();
    EXPECT_NEAR(kSpeed * 3.0 - device.state().pose.position_m[1], kDamping * kSpeed / kStiffness, kSettled);
    EXPECT_NEAR(device.state().velocity_m_per_s[1], kSpeed, 1e-7);
}

TEST(Simulated_operator, Balances_its_energy) {
    constexpr double kQuadrature = 2e-3;  ///< relative: trapezoidal rule with pieces of 50 us
    OperatorConfig config = quiet();
    config.device_damping_n_s_per_m = 0.5;
    config.coulomb_friction_n = 0.2;
    Pose deep;
    deep.position_m = {0.01, 0, -0.02};
    config.path = press_path({}, deep.position_m, 0.05, 0.1);
    SimulatedOperator device = made(config);
    double through_port = 0;
    Vec3 held{}, before{};
    for (int i = 0; i < 400; ++i) {
        (void)device.read();
        const Vec3 x = device.state().pose.position_m;
        for (std::size_t axis = 0; axis < 3; ++axis)
            through_port += held[axis] * (x[axis] - before[axis]);
        before = x;
        held = {0, 0.1 * std::sin(0.05 * i), -300 * x[2]};
        device.write(held, {});
    }
    const OperatorEnergy& e = device.energy();
    const double turned_over = std::abs(e.port_j) + std::abs(e.hand_j) + e.damping_j + e.friction_j;
    EXPECT_GT(e.friction_j, 0);
    EXPECT_GT(e.damping_j, 0);
    EXPECT_LT(e.port_j, 0) << "a spring was pressed";
    EXPECT_NEAR(e.kinetic_j, e.port_j + e.hand_j - e.damping_j - e.friction_j, kQuadrature * turned_over);
    EXPECT_NEAR(e.port_j, through_port, 1e-12) << "counted from outside";
}

TEST(Simulated_operator, Sticks_in_dry_friction_and_creeps_not_a_bit) {
    OperatorConfig config = quiet();
    config.coulomb_friction_n = 0.2;
    SimulatedOperator device = made(config);
    (void)device.read();
    device.write({0.199, 0, 0}, {});
    for (int i = 0; i < 1000; ++i)
        (void)device.read();
    EXPECT_EQ(device.state().pose.position_m, Vec3{});
    device.write({0.5, 0, 0}, {});
    for (int i = 0; i < 3000; ++i)
        (void)device.read();
    // It comes to rest where the spring's pull is within the friction of the force.
    const double spring = config.hand_stiffness_n_per_m * device.state().pose.position_m[0];
    EXPECT_EQ(device.state().velocity_m_per_s, Vec3{});
    EXPECT_GE(spring, 0.3);
    EXPECT_LE(spring, 0.7);
}

TEST(Simulated_operator, Slides_to_rest_at_the_way_that_friction_takes) {
    constexpr double kMass = 0.1, kFriction = 0.4, kImpulse = 0.02;  // N s in one period
    constexpr double kSplitting = 2e-3;  ///< relative: friction acts after each piece
    OperatorConfig config = free_body();
    config.coulomb_friction_n = kFriction;
    SimulatedOperator device = made(config);
    (void)device.read();
    device.write({kImpulse / kPeriod, 0, 0}, {});
    (void)device.read();
    device.write({}, {});
    const double speed = device.state().velocity_m_per_s[0], start = device.state().pose.position_m[0];
    EXPECT_NEAR(speed, (kImpulse - kFriction * kPeriod) / kMass, 1e-12);
    for (int i = 0; i < 100; ++i)
        (void)device.read();
    const double way = device.state().pose.position_m[0] - start;
    EXPECT_EQ(device.state().velocity_m_per_s, Vec3{});
    EXPECT_NEAR(way, speed * speed * kMass / (2 * kFriction), kSplitting * way);
}

TEST(Simulated_operator, Measures_in_whole_counts_of_its_encoders) {
    constexpr double kCount = 55e-6;
    OperatorConfig config = quiet();
    config.position_resolution_m = kCount;
    config.velocity_window = 4;
    config.path = press_path({}, {0.003, -0.004, 0.005}, 0, 0.2);
    SimulatedOperator device = made(config);
    std::vector<DeviceState> samples;
    for (int i = 0; i < 300; ++i) {
        samples.push_back(device.read());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double measured = samples.back().pose.position_m[axis];
            EXPECT_NEAR(measured / kCount, std::round(measured / kCount), 1e-9);
            EXPECT_LE(std::abs(measured - device.state().pose.position_m[axis]), kCount * 0.500001);
        }
        if (i < 4) continue;
        const Vec3 &now = samples[i].pose.position_m, &then = samples[i - 4].pose.position_m;
        EXPECT_DOUBLE_EQ(samples[i].velocity_m_per_s[0],
                         (now[0] - then[0]) / (samples[i].time_s - samples[i - 4].time_s));
    }
    EXPECT_NE(device.state().pose.position_m[0], samples.back().pose.position_m[0]) << "the truth is exact";
}

// Whole and fractional: a push for one period moves the body by an impulse at the delayed time.
TEST(Simulated_operator, Delays_the_force_by_whole_and_fractional_periods) {
    constexpr double kForce = 1, kMass = 0.1;
    for (const double delay : {0.0, 0.25, 1.0, 1.5, 3.75}) {
        OperatorConfig config = free_body();
        config.force_delay_periods = delay;
        SimulatedOperator device = made(config);
        for (int i = 0; i <= 10; ++i) {
            (void)device.read();
            device.write({i == 0 ? kForce : 0, 0, 0}, {});
            const double pushed = std::min(std::max(i - delay, 0.0), 1.0) * kPeriod;
            EXPECT_NEAR(device.state().velocity_m_per_s[0], kForce * pushed / kMass, 1e-12)
                << "delay " << delay << ", sample " << i;
        }
    }
}

TEST(Simulated_operator, Jitters_within_its_bounds_and_the_same_with_the_same_seed) {
    const auto times = [](std::uint64_t seed) {
        OperatorConfig config = quiet();
        config.jitter_periods = 0.8;
        config.seed = seed;
        SimulatedOperator device = made(config);
        std::vector<double> result;
        for (int i = 0; i < 2000; ++i)
            result.push_back(device.read().time_s);
        return result;
    };
    const std::vector<double> first = times(1);
    EXPECT_EQ(first, times(1));
    EXPECT_NE(first, times(2));
    double earliest = 0, latest = 0;
    for (int i = 1; i < 2000; ++i) {
        EXPECT_GT(first[i], first[i - 1]);
        earliest = std::min(earliest, first[i] / kPeriod - i);
        latest = std::max(latest, first[i] / kPeriod - i);
    }
    EXPECT_GE(earliest, -0.4);
    EXPECT_LE(latest, 0.4);
    EXPECT_LT(earliest, -0.38) << "the whole range is used";
    EXPECT_GT(latest, 0.38);
}

TEST(Simulated_operator, Saturates_by_norm_and_takes_no_force_that_is_not_finite) {
    OperatorConfig config = free_body();
    config.max_force_n = 3.3;
    config.max_torque_nm = 0.1;
    SimulatedOperator device = made(config);
    (void)device.read();
    device.write({300, 400, 0}, {0, 0, -2});
    const Vec3 force = device.state().force_n;
    EXPECT_NEAR(force[0], 3.3 * 0.6, 1e-12);
    EXPECT_NEAR(force[1], 3.3 * 0.8, 1e-12);
    EXPECT_NEAR(device.state().torque_nm[2], -0.1, 1e-15);
    device.write({std::numeric_limits<double>::quiet_NaN(), 1, 0}, {});
    EXPECT_EQ(device.state().force_n, Vec3{});
}

TEST(Simulated_operator, Turns_as_a_torsion_pendulum) {
    constexpr double kInertia = 2e-5, kStiffness = 1, kTorque = 0.1;
    constexpr double kSettled = 1e-6;  ///< rad
    OperatorConfig config = quiet();
    config.inertia_kg_m2 = kInertia;
    config.hand_stiffness_nm_per_rad = kStiffness;
    SimulatedOperator device = made(config);
    (void)device.read();
    device.write({}, {0, kTorque, 0});
    for (int i = 0; i < 500; ++i)
        (void)device.read();
    const auto& q = device.state().pose.orientation_wxyz;
    EXPECT_NEAR(2 * std::atan2(q[2], q[0]), kTorque / kStiffness, kSettled);
    EXPECT_NEAR(device.energy().port_j, kTorque * kTorque / kStiffness, kSettled);
}

TEST(Simulated_operator, Under_a_constant_torque_turns_as_a_free_body) {
    constexpr double kInertia = 2e-5, kTorque = 0.02, kSeconds = 0.05;
    constexpr double kPieces =
        2e-3;  ///< relative: semi-implicit pieces of 50 us are ahead by one of 2,000 halves
    OperatorConfig config = free_body();
    config.inertia_kg_m2 = kInertia;
    config.hand_stiffness_nm_per_rad = config.hand_damping_nm_s_per_rad = 0;
    SimulatedOperator device = made(config);
    (void)device.read();
    device.write({}, {kTorque, 0, 0});
    for (int i = 0; i < 50; ++i)
        (void)device.read();
    const double angle = 0.5 * kTorque / kInertia * kSeconds * kSeconds;  // 1.25 rad
    const auto& q = device.state().pose.orientation_wxyz;
    EXPECT_NEAR(2 * std::atan2(q[1], q[0]), angle, kPieces * angle);
    EXPECT_NEAR(device.energy().port_j, kTorque * angle, kPieces * kTorque * angle);
}

TEST(Simulated_operator, Without_inertia_turns_as_the_hand_wants) {
    OperatorConfig config = quiet();
    Pose turned;
    turned.orientation_wxyz = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
    config.path = {{0, {}}, {0.2, turned}};
    SimulatedOperator device = made(config);
    for (int i = 0; i <= 100; ++i)
        (void)device.read();
    const auto& q = device.state().pose.orientation_wxyz;
    EXPECT_NEAR(2 * std::atan2(q[3], q[0]), std::acos(-1.0) / 4, 1e-4) << "half way in half the time";
}

// Colgate and Schenkel: a wall k, b sampled at T on a device of damping c is passive if c > k T / 2 + |b|,
// and not otherwise. Pressed in by the hand and left to hold, the wall beyond it must give more than it
// stored.
TEST(Simulated_operator, Finds_the_walls_of_Colgate_passive_below_the_bound_and_active_above) {
    constexpr double kDamping = 1.0;  // bound: 2 c / T = 2,000 N/m
    const auto port_peak = [](double wall_n_per_m) {
        OperatorConfig config = quiet();
        config.device_damping_n_s_per_m = kDamping;
        config.hand_stiffness_n_per_m = 200;
        config.hand_damping_n_s_per_m = 0;
        config.path = press_path({}, {0, 0, -0.01}, 0.01, 0.05);
        SimulatedOperator device = made(config);
        for (int i = 0; i < 3000; ++i) {
            const double z = device.read().pose.position_m[2];
            device.write({0, 0, -wall_n_per_m * z}, {});  // bilateral: always in contact
        }
        return device.energy().port_j + 0.5 * wall_n_per_m * std::pow(device.state().pose.position_m[2], 2);
    };
    EXPECT_LT(port_peak(1000), 2e-4);
    EXPECT_GT(port_peak(8000), 0.1);
}

TEST(Simulated_operator, Refuses_each_number_out_of_range_by_its_name) {
    struct Case {
        const char* name;
        std::function<void(OperatorConfig&)> change;
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Case cases[] = {
        {"device_mass_kg", [](auto& c) { c.device_mass_kg = -1; }},
        {"both zero", [](auto& c) { c.device_mass_kg = c.hand_mass_kg = 0; }},
        {"coulomb_friction_n", [&](auto& c) { c.coulomb_friction_n = nan; }},
        {"period_s", [](auto& c) { c.period_s = 0; }},
        {"jitter_periods", [](auto& c) { c.jitter_periods = 1; }},
        {"force_delay_periods", [](auto& c) { c.force_delay_periods = 65; }},
        {"velocity_window", [](auto& c) { c.velocity_window = 0; }},
        {"hand_stiffness_n_per_m", [](auto& c) { c.hand_stiffness_n_per_m = 1e9 / 1e4 * 1e3; }},
        {"hand_stiffness_nm_per_rad", [](auto& c) { c.inertia_kg_m2 = 1e-12; }},
        {"path[1]: the time goes back",
         [](auto& c) {
             c.path = {{1, {}}, {0.5, {}}};
         }},
        {"path[0]: not a pose",
         [&](auto& c) {
             c.path = {{0, {{nan, 0, 0}, {1, 0, 0, 0}}}};
         }},
        {"path[0]: not a pose",
         [](auto& c) {
             c.path = {{0, {{}, {2, 0, 0, 0}}}};
         }},
    };
    for (const Case& bad : cases) {
        OperatorConfig config = quiet();
        bad.change(config);
        const auto result = SimulatedOperator::create(config);
        ASSERT_FALSE(result.ok()) << bad.name;
        EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
        EXPECT_THAT(result.error().text(), HasSubstr(bad.name));
    }
}

}  // namespace
}  // namespace knead
