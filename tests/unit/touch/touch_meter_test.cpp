// SPDX-License-Identifier: Apache-2.0
#include "touch/touch_meter.h"

#include <gtest/gtest.h>

#include <thread>

#include "touch/snapshot.h"
#include "touch/status_words.h"

namespace knead::tools::test {
namespace {

HapticTick tick_at(double z_m, double force_z_n, std::uint32_t status = kHapticOk) {
    HapticTick tick;
    tick.dt_s = 1e-3;
    tick.device.pose.position_m = tick.hand.position_m = tick.tool.position_m = {0, 0, z_m};
    tick.device_force_n = tick.scene_force_n = {0, 0, force_z_n};
    tick.status = status;
    return tick;
}

TouchMeter downwards() {
    return TouchMeter({0, 0, 0}, {0, 0, -1});
}

// By hand: 2 N against 3 mm on the way in, 1 N along 3 mm on the way out.
TEST(Touch_meter, Of_a_held_force_counts_the_work_of_the_hand) {
    constexpr double kRounding = 1e-15;
    TouchMeter meter = downwards();
    meter.see(tick_at(0, 2));
    meter.see(tick_at(-3e-3, 1));
    EXPECT_NEAR(meter.totals().absorbed_j, 6e-3, kRounding);
    meter.see(tick_at(0, 0));
    EXPECT_NEAR(meter.totals().absorbed_j, 3e-3, kRounding);
    EXPECT_EQ(meter.totals().least_absorbed_j, 0);
}

TEST(Touch_meter, Of_an_object_that_pays_remembers_the_least_energy) {
    constexpr double kRounding = 1e-15;
    TouchMeter meter = downwards();
    meter.see(tick_at(-1e-3, 1));
    meter.see(tick_at(1e-3, 1));
    meter.see(tick_at(-1e-3, 0));
    EXPECT_NEAR(meter.totals().least_absorbed_j, -2e-3, kRounding);
    EXPECT_NEAR(meter.totals().absorbed_j, 0, kRounding);
}

TEST(Touch_meter, Keeps_the_largest_of_what_it_sees) {
    TouchMeter meter = downwards();
    meter.see(tick_at(-2e-3, 1.5));
    meter.see(tick_at(-1e-3, -0.5));
    const TouchTotals& t = meter.totals();
    EXPECT_EQ(t.ticks, 2U);
    EXPECT_DOUBLE_EQ(t.largest_force_n, 1.5);
    EXPECT_DOUBLE_EQ(t.force_n, 0.5);
    EXPECT_DOUBLE_EQ(t.largest_tool_depth_m, 2e-3);
    EXPECT_DOUBLE_EQ(t.tool_depth_m, 1e-3);
}

TEST(Touch_meter, Counts_ticks_of_each_status_and_forgets_the_recent_after_a_tenth_of_a_second) {
    TouchMeter meter = downwards();
    meter.see(tick_at(0, 0, kHapticSaturated | kHapticStepFailed));
    EXPECT_EQ(meter.totals().recent_haptic_status, kHapticSaturated | kHapticStepFailed);
    for (int i = 0; i < 90; ++i)
        meter.see(tick_at(0, 0));
    EXPECT_EQ(meter.totals().recent_haptic_status, kHapticSaturated | kHapticStepFailed);
    for (int i = 0; i < 20; ++i)
        meter.see(tick_at(0, 0));
    EXPECT_EQ(meter.totals().recent_haptic_status, 0U);
    EXPECT_EQ(meter.totals().haptic_status_ticks[0], 1U);
    EXPECT_EQ(meter.totals().haptic_status_ticks[10], 1U);
    EXPECT_DOUBLE_EQ(meter.totals().saturated_share(), 1.0 / 111);
}

TEST(Status_words, Name_every_bit_of_both_kinds) {
    EXPECT_EQ(status_words(0, 0), "ok");
    EXPECT_EQ(status_words(kHapticSlewLimited | kHapticRamping, 0), "slew limited, ramping");
    EXPECT_EQ(status_words(kHapticStepFailed, kStepContactCap), "step failed, contact cap");
    EXPECT_EQ(status_words(kHapticBadPose, kStepNotFinite), "bad pose, step not finite");
}

TEST(Snapshot, Read_while_it_is_written_is_always_whole) {
    struct Value {
        std::uint64_t first = 0, more[62] = {}, last = 0;
    };
    constexpr std::uint64_t kWrites = 1'000'000;  ///< some tens of milliseconds: both are at it together
    Snapshot<Value> snapshot;
    std::thread writer([&] {
        for (std::uint64_t i = 1; i <= kWrites; ++i) {
            Value value;
            value.first = value.last = i;
            for (std::uint64_t& word : value.more)
                word = i;
            snapshot.write(value);
        }
    });
    std::uint64_t newest = 0, torn = 0;
    while (newest < kWrites) {
        const Value value = snapshot.read();
        bool whole = value.first == value.last && value.first >= newest;
        for (const std::uint64_t word : value.more)
            whole = whole && word == value.first;
        if (!whole) ++torn;
        newest = value.first;
    }
    writer.join();
    EXPECT_EQ(torn, 0U);
}

}  // namespace
}  // namespace knead::tools::test
