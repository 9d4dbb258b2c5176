// SPDX-License-Identifier: Apache-2.0
// Nothing on the way from pose to force allocates or locks, in virtual time, where no clock is read either.
#include <gtest/gtest.h>

#include <new>

#include "unit/haptics/loop_parts.h"
#include "unit/runtime/watched_calls.h"

namespace knead::test {
namespace {

/// Press, hold, leave, a bad pose and a jump.
WatchedCalls calls_of(HapticConfig config) {
    PlacedDevice device;
    Touch touch(config, device, touched_cube(ToolContact::sticking));
    const WatchedCalls before = watched_calls();
    for (int i = 0; i < 600; ++i) {
        const double depth = 0.01 * std::sin(2 * M_PI * i / 300.0);
        device.state.pose.position_m[2] = 0.1 - depth;
        if (i == 400) device.state.pose.position_m[0] = std::nan("");
        if (i == 401) device.state.pose.position_m[0] = 0.05;
        if (i == 450) device.state.pose.position_m[0] = 1.05;
        if (i == 460) device.state.pose.position_m[0] = 0.05;
        (void)touch.tick();
    }
    return watched_calls() - before;
}

TEST(Tick, neither_allocates_nor_locks) {
    for (const bool turns : {false, true}) {
        for (const HapticMode mode : {HapticMode::synchronous, HapticMode::two_rate}) {
            for (const LocalRendering rendering :
                 {LocalRendering::reduced_object, LocalRendering::linear, LocalRendering::hold}) {
                HapticConfig config;
                config.mode = mode;
                config.rendering = rendering;
                if (turns) config.coupling.rotation_stiffness_nm_per_rad = 0.5;
                const WatchedCalls calls = calls_of(config);
                EXPECT_EQ(calls.allocations, 0) << static_cast<int>(mode) << static_cast<int>(rendering);
                EXPECT_EQ(calls.frees, 0);
                EXPECT_EQ(calls.locks, 0);
            }
        }
    }
}

TEST(WatchedCalls, see_what_a_tick_must_not_do) {
    const WatchedCalls before = watched_calls();
    ::operator delete(::operator new(1));
    EXPECT_GT((watched_calls() - before).allocations, 0);
}

}  // namespace
}  // namespace knead::test
