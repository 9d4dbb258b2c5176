// SPDX-License-Identifier: Apache-2.0
#include "touch/touch_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/error.h"
#include "knead/haptics/session.h"
#include "touch/touch_report.h"
#include "unit/runtime/block_asset.h"

namespace knead::tools::test {
namespace {

using knead::test::cube_asset;
using ::testing::HasSubstr;

constexpr std::uint32_t kCells = 2;  ///< 48 tetrahedra: a second of virtual time takes milliseconds
const std::string kHash(64, 'a');

Asset cube(ToolContact contact = ToolContact::bonded) {
    return cube_asset(kCells, ToolShape::plate, contact);
}

DevicePreset desktop() {
    DevicePreset preset;
    preset.name = "desktop";
    preset.max_force_n.value = 3;
    preset.max_stiffness_n_per_m.value = 500;
    preset.position_resolution_m.value = 5e-5;
    preset.apparent_mass_kg.value = 0.05;
    return preset;
}

TouchRequest quick(HapticMode mode) {
    TouchRequest request;
    request.press.hold_s = 0.1;
    request.mode = mode;
    request.virtual_time = true;
    return request;
}

/// Remembers what was written last.
class LastForce final : public Device {
  public:
    explicit LastForce(Device& device) : device_(device) {}
    DeviceState read() noexcept override { return device_.read(); }
    void write(const Vec3& force_n, const Vec3& torque_n_m) noexcept override {
        largest_n = std::max(largest_n, std::abs(force_n[2]));
        last_n = force_n;
        device_.write(force_n, torque_n_m);
    }
    Vec3 last_n{1, 1, 1};
    double largest_n = 0;

  private:
    Device& device_;
};

TouchOutcome run(const Asset& asset, const TouchRequest& request, const TouchListener& listener = {}) {
    const TouchSetup setup = make_touch_setup(asset, desktop(), request);
    return run_touch(asset, kHash, setup, *make_device(setup, desktop()), true, listener);
}

class Touch_run : public ::testing::TestWithParam<HapticMode> {};

TEST_P(Touch_run, In_virtual_time_gives_the_same_summary_and_log_each_time) {
    const Asset asset = cube();
    for (const bool hand : {false, true}) {
        TouchRequest request = quick(GetParam());
        request.simulated_hand = hand;
        const TouchSetup setup = make_touch_setup(asset, desktop(), request);
        const TouchOutcome a = run(asset, request), b = run(asset, request);
        EXPECT_EQ(touch_summary_json(asset, kHash, setup, a), touch_summary_json(asset, kHash, setup, b));
        EXPECT_EQ(a.log->ticks.force_n, b.log->ticks.force_n);
        EXPECT_GT(a.totals.largest_force_n, 0.1) << "it was in contact";
    }
}

TEST_P(Touch_run, Log_replays_with_the_same_bits) {
    const Asset asset = cube(ToolContact::frictionless);
    TouchRequest request = quick(GetParam());
    request.simulated_hand = true;
    const TouchOutcome outcome = run(asset, request);
    EXPECT_EQ(outcome.log->ticks.number.size(), outcome.totals.ticks);
    Simulation simulation =
        value_or_throw(Simulation::create(asset, value_or_throw(simulation_config_of(*outcome.log))));
    const ReplayReport report = value_or_throw(replay(*outcome.log, simulation));
    EXPECT_TRUE(report.same) << report.first_difference;
    EXPECT_EQ(report.ticks, outcome.totals.ticks);
}

TEST_P(Touch_run, Ends_with_zero_force_also_when_interrupted) {
    const Asset asset = cube();
    for (const bool interrupts : {false, true}) {
        TouchRequest request = quick(GetParam());
        request.seconds = 0.6;  // in the middle of the press
        const TouchSetup setup = make_touch_setup(asset, desktop(), request);
        const auto script = make_device(setup, desktop());
        LastForce device(*script);
        TouchListener listener;
        int asked = 0;
        listener.interrupted = [&] { return interrupts && ++asked > 450; };
        const TouchOutcome outcome = run_touch(asset, kHash, setup, device, false, listener);
        EXPECT_EQ(outcome.interrupted, interrupts);
        EXPECT_EQ(outcome.totals.ticks, interrupts ? 450U : 600U);
        EXPECT_GT(device.largest_n, 0.1) << "there was a force";
        EXPECT_EQ(device.last_n, Vec3{});
    }
}

TEST_P(Touch_run, Never_exceeds_the_largest_force_that_was_asked_for) {
    TouchRequest request = quick(GetParam());
    request.max_force_n = 0.25;
    const TouchOutcome outcome = run(cube(), request);
    EXPECT_LE(outcome.totals.largest_force_n, 0.25);
    EXPECT_GT(outcome.totals.largest_scene_force_n, 0.5);
    EXPECT_GT(outcome.totals.saturated_share(), 0.05);
}

// Real time, but nothing is asked of the clock except that it goes on.
TEST_P(Touch_run, In_real_time_shows_and_stops_and_can_be_replayed) {
    const Asset asset = cube();
    TouchRequest request = quick(GetParam());
    request.virtual_time = false;
    request.seconds = 0.2;
    int shown = 0;
    TouchListener listener;
    listener.show_period_s = 0.02;
    listener.show = [&](const TouchTotals&, const RunStatistics&) { ++shown; };
    const TouchOutcome outcome = run(asset, request, listener);
    EXPECT_GT(shown, 0);
    EXPECT_GT(outcome.totals.ticks, 0U);
    Simulation simulation =
        value_or_throw(Simulation::create(asset, value_or_throw(simulation_config_of(*outcome.log))));
    const ReplayReport report = value_or_throw(replay(*outcome.log, simulation));
    EXPECT_TRUE(report.same) << report.first_difference;
    EXPECT_EQ(report.ticks, outcome.totals.ticks);
}

INSTANTIATE_TEST_SUITE_P(Modes, Touch_run, ::testing::Values(HapticMode::synchronous, HapticMode::two_rate),
                         [](const auto& mode) {
                             return std::string(mode.param == HapticMode::synchronous ? "synchronous"
                                                                                      : "two_rate");
                         });

TEST(Touch_setup, Takes_limits_and_coupling_from_the_device_and_the_request_before_it) {
    const Asset asset = cube();
    TouchRequest request;
    const TouchSetup plain = make_touch_setup(asset, desktop(), request);
    EXPECT_DOUBLE_EQ(plain.haptic.safety.max_force_n, 3);
    EXPECT_DOUBLE_EQ(plain.haptic.coupling.stiffness_n_per_m, 500);
    EXPECT_DOUBLE_EQ(plain.simulation.coupling_stiffness_n_per_m, 500);
    request.max_force_n = 1;
    request.coupling_n_per_m = 200;
    const TouchSetup asked = make_touch_setup(asset, desktop(), request);
    EXPECT_DOUBLE_EQ(asked.haptic.safety.max_force_n, 1);
    EXPECT_DOUBLE_EQ(asked.haptic.coupling.stiffness_n_per_m, 200);
}

TEST(Touch_setup, Presses_where_a_plate_looks_and_where_the_object_is) {
    constexpr double kRounding = 1e-12;
    Asset asset = cube();
    EXPECT_NEAR(press_line(asset, 0).direction[2], -1, kRounding);
    // A quarter turn about x takes the plate's -z to the scene's +y.
    asset.tools[0].rest_orientation_wxyz = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};
    EXPECT_NEAR(press_line(asset, 0).direction[1], 1, kRounding);
    // A lying capsule's own -z is along the surface: it presses down all the same.
    const Asset lying = cube_asset(kCells, ToolShape::capsule, ToolContact::frictionless);
    EXPECT_NEAR(press_line(lying, 0).direction[2], -1, kRounding);
    EXPECT_NEAR(press_line(lying, 0, Vec3{0, 3, 4}).direction[2], 0.8, kRounding);
}

TEST(Touch_setup, Of_a_tool_that_is_not_there_says_which_there_are) {
    const Asset asset = cube();
    EXPECT_EQ(find_tool(asset, "0"), 0U);
    EXPECT_EQ(find_tool(asset, "tool"), 0U);
    try {
        (void)find_tool(asset, "fork");
        FAIL() << "it was found";
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_usage);
        EXPECT_THAT(error.what(), HasSubstr("0 tool"));
    }
}

TEST(Touch_setup, Of_a_run_longer_than_an_hour_is_refused) {
    TouchRequest request;
    request.press.hold_s = 3601;
    EXPECT_THROW((void)make_touch_setup(cube(), desktop(), request), ToolError);
}

}  // namespace
}  // namespace knead::tools::test
