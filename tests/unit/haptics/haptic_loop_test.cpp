// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/haptic_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "knead/haptics/scripted_device.h"
#include "unit/haptics/loop_parts.h"
#include "unit/runtime/block_asset.h"

namespace knead::test {
namespace {

Simulation make_simulation() {
    auto made = Simulation::create(cube_asset(3, ToolShape::plate, ToolContact::sticking));
    EXPECT_TRUE(made.ok());
    return std::move(made).value();
}

PressScript press_by(double depth_m) {
    PressScript script;
    script.start.position_m = {0.05, 0.05, 0.1};
    script.travel_m = {0, 0, -depth_m};
    script.wait_s = 0.01;
    script.press_s = 0.05;
    script.hold_s = 0.02;
    script.release_s = 0.05;
    script.rest_s = 0.02;
    return script;
}

HapticLoop make_loop(Device& device, Simulation& simulation, const HapticConfig& config) {
    auto loop = HapticLoop::create(device, simulation, config);
    EXPECT_TRUE(loop.ok());
    return std::move(loop).value();
}

TEST(PressSamples, wait_ramp_hold_come_back_and_rest) {
    const std::vector<DeviceState> samples = press_samples(press_by(0.01));
    ASSERT_EQ(samples.size(), 151u);
    const auto z = [&](std::size_t i) { return samples[i].pose.position_m[2]; };
    EXPECT_EQ(z(0), 0.1);
    EXPECT_EQ(z(9), 0.1);
    EXPECT_NEAR(z(35), 0.095, 1e-12);
    EXPECT_NEAR(samples[35].velocity_m_per_s[2], -0.2, 1e-12);
    EXPECT_NEAR(z(70), 0.09, 1e-12);
    EXPECT_NEAR(z(105), 0.095, 1e-12);
    EXPECT_NEAR(samples[105].velocity_m_per_s[2], 0.2, 1e-12);
    EXPECT_EQ(z(140), 0.1);
    EXPECT_EQ(samples[140].time_s, 0.14);
}

TEST(PressSamples, without_a_release_end_at_the_deepest_point) {
    PressScript script = press_by(0.01);
    script.release_s = 0;
    const std::vector<DeviceState> samples = press_samples(script);
    ASSERT_EQ(samples.size(), 81u);
    EXPECT_NEAR(samples.back().pose.position_m[2], 0.09, 1e-12);
}

TEST(PressSamples, of_a_bad_script_are_empty) {
    for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        PressScript script = press_by(0.01);
        script.press_s = bad;
        EXPECT_TRUE(press_samples(script).empty()) << bad;
    }
    for (const double bad : {0.0, -1.0, std::nan(""), 1e12}) {
        PressScript script = press_by(0.01);
        script.rate_hz = bad;
        EXPECT_TRUE(press_samples(script).empty()) << bad;
    }
}

TEST(ScriptedDevice, replays_its_samples_then_stays_and_records_forces) {
    std::vector<DeviceState> samples(2);
    samples[1].buttons = 5;
    ScriptedDevice device(samples);
    EXPECT_EQ(device.read().buttons, 0u);
    EXPECT_FALSE(device.finished());
    EXPECT_EQ(device.read().buttons, 5u);
    EXPECT_TRUE(device.finished());
    EXPECT_EQ(device.read().buttons, 5u);
    for (int i = 0; i < 3; ++i)
        device.write({1.0 * i, 0, 0}, {});
    ASSERT_EQ(device.forces_n().size(), 2u);  // one per sample, no more
    EXPECT_EQ(device.forces_n()[1][0], 1);
    device.rewind();
    EXPECT_TRUE(device.forces_n().empty());
    EXPECT_EQ(device.read().buttons, 0u);
}

TEST(HapticLoop, replays_a_script_with_the_same_bits) {
    Simulation simulation = make_simulation();
    ScriptedDevice device(press_samples(press_by(0.01)));
    std::vector<Vec3> first;
    for (int run = 0; run < 2; ++run) {
        HapticLoop loop = make_loop(device, simulation, {});
        device.rewind();
        simulation.reset();
        while (!device.finished())
            (void)loop.tick(1e-3);
        if (run == 0) first = device.forces_n();
    }
    ASSERT_EQ(first.size(), device.forces_n().size());
    EXPECT_EQ(std::memcmp(first.data(), device.forces_n().data(), first.size() * sizeof(Vec3)), 0);
    EXPECT_GT(first[80][2], 0.5);
}

TEST(HapticLoop, maps_poses_into_the_scene_and_forces_back) {
    Simulation simulation = make_simulation();
    const double half = std::sqrt(0.5);
    HapticConfig config;
    config.workspace.scale = 2;
    config.workspace.rotation_wxyz = {half, half, 0, 0};  // device y is scene z, device z is scene -y
    config.workspace.offset_m = {0.05, 0.05, 0.1};
    config.force_scale = 0.5;
    config.safety = open_safety();
    PlacedDevice device;
    device.state.pose.position_m = {0.001, -0.002, 0.003};
    // The tool must keep the scene's orientation: undo the map's turn.
    device.state.pose.orientation_wxyz = {half, -half, 0, 0};
    HapticLoop loop = make_loop(device, simulation, config);
    for (int i = 0; i < 100; ++i)
        (void)loop.tick(1e-3);
    const HapticTick tick = loop.tick(1e-3);
    EXPECT_EQ(tick.number, 101u);
    EXPECT_NEAR(tick.hand.position_m[0], 0.052, 1e-12);
    EXPECT_NEAR(tick.hand.position_m[1], 0.044, 1e-12);
    EXPECT_NEAR(tick.hand.position_m[2], 0.096, 1e-12);
    EXPECT_NEAR(tick.hand.orientation_wxyz[0], 1, 1e-12);
    ASSERT_GT(std::abs(tick.step.force_n[2]), 1e-3);
    EXPECT_EQ(tick.scene_force_n, tick.step.force_n);
    EXPECT_NEAR(tick.device_force_n[0], 0.5 * tick.step.force_n[0], 1e-9);
    EXPECT_NEAR(tick.device_force_n[1], 0.5 * tick.step.force_n[2], 1e-9);
    EXPECT_NEAR(tick.device_force_n[2], -0.5 * tick.step.force_n[1], 1e-9);
    EXPECT_EQ(device.force, tick.device_force_n);
}

TEST(HapticLoop, shortens_a_force_above_the_limit_and_keeps_its_direction) {
    Simulation simulation = make_simulation();
    HapticConfig config;
    config.safety = open_safety();
    config.safety.max_force_n = 2;
    PressScript script = press_by(0.01);
    script.travel_m = {0.005, 0.002, -0.01};
    ScriptedDevice device(press_samples(script));
    HapticLoop loop = make_loop(device, simulation, config);
    bool saturated = false;
    while (!device.finished()) {
        const HapticTick tick = loop.tick(1e-3);
        if (tick.number == 1) continue;  // the ramp starts at zero
        const Vec3& f = tick.device_force_n;
        const double norm = length(f), wanted = length(tick.scene_force_n);
        ASSERT_LE(norm, 2 * (1 + 1e-12));
        ASSERT_EQ((tick.status & kHapticSaturated) != 0, wanted > 2);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            ASSERT_NEAR(f[axis] * wanted, tick.scene_force_n[axis] * norm, 1e-9 * wanted * wanted + 1e-12);
        }
        saturated = saturated || (tick.status & kHapticSaturated) != 0;
    }
    EXPECT_TRUE(saturated);
}

TEST(HapticLoop, whose_scaled_force_overflows_writes_zero_and_says_so) {
    Simulation simulation = make_simulation();
    HapticConfig config;
    config.force_scale = 1e308;
    ScriptedDevice device(press_samples(press_by(0.02)));
    HapticLoop loop = make_loop(device, simulation, config);
    bool seen = false;
    while (!device.finished()) {
        const HapticTick tick = loop.tick(1e-3);
        ASSERT_LE(length(tick.device_force_n), config.safety.max_force_n * (1 + 1e-12));
        seen = seen || (tick.status & kHapticNotFinite) != 0;
    }
    EXPECT_TRUE(seen);
}

TEST(SimulationConfig, of_a_loop_has_its_coupling_its_rate_and_what_its_mode_needs) {
    HapticConfig config;
    config.coupling.stiffness_n_per_m = 123;
    config.coupling.damping_n_s_per_m = 4;
    config.coupling.tool_mass_kg = 0.06;
    config.rate_hz = 2000;
    SimulationConfig base;
    base.force_tolerance = 1e-2;
    SimulationConfig made = simulation_config(config, base);
    EXPECT_EQ(made.force_tolerance, 1e-2);
    EXPECT_EQ(made.expected_dt_s, 1.0 / 2000);
    EXPECT_EQ(made.coupling_stiffness_n_per_m, 123);
    EXPECT_EQ(made.coupling_damping_n_s_per_m, 4);
    EXPECT_EQ(made.tool_mass_kg, 0.06);
    EXPECT_FALSE(made.with_local_model);
    EXPECT_FALSE(made.with_torque);
    config.mode = HapticMode::two_rate;
    config.simulation_rate_hz = 60;
    made = simulation_config(config, base);
    EXPECT_EQ(made.expected_dt_s, 1.0 / 60);
    EXPECT_TRUE(made.with_local_model);
    config.mode = HapticMode::synchronous;
    config.coupling.rotation_stiffness_nm_per_rad = 1;
    made = simulation_config(config, base);
    EXPECT_TRUE(made.with_torque);
    EXPECT_TRUE(made.with_local_model);
}

TEST(HapticLoop, with_bad_numbers_is_refused_by_name) {
    Simulation simulation = make_simulation();
    ScriptedDevice device({});
    const auto refused = [&](const char* name, auto&& change) {
        HapticConfig config;
        change(config);
        const auto loop = HapticLoop::create(device, simulation, config);
        ASSERT_FALSE(loop.ok()) << name;
        EXPECT_EQ(loop.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(loop.error().message.find(name), std::string::npos) << loop.error().message;
    };
    const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
    refused("force_scale", [](auto& c) { c.force_scale = -1; });
    refused("workspace.scale", [](auto& c) { c.workspace.scale = 0; });
    refused("workspace.rotation_wxyz", [](auto& c) { c.workspace.rotation_wxyz = {1, 1, 0, 0}; });
    refused("workspace.offset_m", [&](auto& c) { c.workspace.offset_m[1] = nan; });
    for (const double bad : {499.0, 4001.0, nan})
        refused("rate_hz", [&](auto& c) { c.rate_hz = bad; });
    for (const double bad : {49.0, 4001.0, nan})
        refused("simulation_rate_hz", [&](auto& c) { c.simulation_rate_hz = bad; });
    for (const double bad : {0.0, 1.1, nan})
        refused("correction_gain", [&](auto& c) { c.correction_gain = bad; });
    refused("mode", [](auto& c) { c.mode = static_cast<HapticMode>(7); });
    refused("rendering", [](auto& c) { c.rendering = static_cast<LocalRendering>(7); });
    for (const double bad : {0.0, infinite, nan}) {
        refused("coupling.stiffness_n_per_m", [&](auto& c) { c.coupling.stiffness_n_per_m = bad; });
        refused("coupling.tool_mass_kg", [&](auto& c) { c.coupling.tool_mass_kg = bad; });
        refused("coupling.tool_inertia_kg_m2", [&](auto& c) { c.coupling.tool_inertia_kg_m2 = bad; });
    }
    for (const double bad : {-1.0, infinite, nan}) {
        refused("coupling.damping_n_s_per_m", [&](auto& c) { c.coupling.damping_n_s_per_m = bad; });
        refused("coupling.rotation_stiffness",
                [&](auto& c) { c.coupling.rotation_stiffness_nm_per_rad = bad; });
        refused("coupling.rotation_damping",
                [&](auto& c) { c.coupling.rotation_damping_nm_s_per_rad = bad; });
    }
    refused("max_force_n", [](auto& c) { c.safety.max_force_n = 0; });
    HapticLoop loop = make_loop(device, simulation, {});
    EXPECT_FALSE(loop.run(-1).ok());
    EXPECT_FALSE(loop.run(nan).ok());
}

}  // namespace
}  // namespace knead::test
