// SPDX-License-Identifier: Apache-2.0
// The loop on threads of its own. Nothing here is about how fast it is: the machine may be busy.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "unit/haptics/loop_parts.h"

namespace knead::test {
namespace {

/// May be written by the loop's thread while the test looks.
class SharedDevice final : public Device {
  public:
    DeviceState read() noexcept override {
        DeviceState state;
        state.pose.position_m = {0.05, 0.05, 0.097};
        state.time_s = 1e-3 * static_cast<double>(++reads);
        return state;
    }
    void write(const Vec3& force_n, const Vec3& /*torque_nm*/) noexcept override {
        force_z = force_n[2];
        if (force_n[2] > 0) pushed = true;
    }
    std::atomic<std::uint64_t> reads{0};
    std::atomic<double> force_z{-1};
    std::atomic<bool> pushed{false};
};

struct Threads : ::testing::TestWithParam<HapticMode> {
    Threads() {
        config.mode = GetParam();
        config.safety.ramp_n_per_s = 1000;
        simulation = std::make_unique<Simulation>(
            Simulation::create(touched_cube(), simulation_config(config)).value());
        loop = std::make_unique<HapticLoop>(HapticLoop::create(device, *simulation, config).value());
    }
    /// Until the loop has pushed, or a minute is over.
    void wait_for_push() const {
        for (int i = 0; i < 60'000 && !device.pushed; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ASSERT_TRUE(device.pushed);
    }

    HapticConfig config;
    SharedDevice device;
    std::unique_ptr<Simulation> simulation;
    std::unique_ptr<HapticLoop> loop;
};

TEST_P(Threads, push_until_they_are_stopped_and_leave_no_force) {
    std::atomic<std::uint64_t> seen{0};
    EXPECT_FALSE(loop->running());
    for (int round = 0; round < 3; ++round) {
        device.pushed = false;
        ASSERT_TRUE(loop->start([&](const HapticTick& tick) { seen = tick.number; }).ok());
        EXPECT_TRUE(loop->running());
        wait_for_push();
        (void)loop->statistics();  // while it runs
        loop->stop();
        EXPECT_FALSE(loop->running());
        EXPECT_EQ(device.force_z, 0);
        const RunStatistics s = loop->statistics();
        EXPECT_GT(s.ticks, 0u);
        EXPECT_EQ(s.tick.count, s.ticks);
        EXPECT_EQ(s.haptic.count, s.ticks);
        EXPECT_GT(s.simulation.count, 0u);
        EXPECT_EQ(s.misses, s.misses_ours + s.misses_preempted);
        EXPECT_LE(s.haptic.p50_s, s.haptic.max_s);
        EXPECT_EQ(s.step_status, kStepOk);
        EXPECT_TRUE(s.realtime_priority || s.realtime_error != 0);
    }
    EXPECT_EQ(seen, device.reads);
}

TEST_P(Threads, are_joined_when_the_loop_goes_away) {
    ASSERT_TRUE(loop->start().ok());
    wait_for_push();
    HapticLoop moved = std::move(*loop);
    EXPECT_TRUE(moved.running());
    loop.reset();
    {
        const HapticLoop last = std::move(moved);
        EXPECT_TRUE(last.running());
    }
    EXPECT_EQ(device.force_z, 0);
    const std::uint64_t reads = device.reads;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(device.reads, reads);
}

TEST_P(Threads, do_not_start_twice) {
    ASSERT_TRUE(loop->start().ok());
    const Status again = loop->start();
    ASSERT_FALSE(again.ok());
    EXPECT_EQ(again.error().code, ErrorCode::invalid_argument);
    EXPECT_FALSE(loop->run(0.01).ok());
    loop->stop();
}

TEST_P(Threads, run_on_the_calling_one_for_as_many_ticks_as_asked) {
    std::uint64_t observed = 0;
    const auto run = loop->run(0.05, [&](const HapticTick&) { ++observed; });
    ASSERT_TRUE(run.ok());
    EXPECT_EQ(run.value().ticks, 50u);
    EXPECT_EQ(observed, 50u);
    EXPECT_EQ(device.force_z, 0);
    EXPECT_FALSE(loop->running());
    // Lost periods are left out, never made up for: it cannot be faster than the clock.
    EXPECT_GE(run.value().seconds, 0.049 * 0.98);
    EXPECT_GT(run.value().longest_tick_s, 0);
    EXPECT_EQ(loop->run(0).value().ticks, 0u);
}

TEST_P(Threads, of_a_run_end_when_another_thread_says_so) {
    std::thread other([&] {
        wait_for_push();
        loop->stop();
    });
    const auto run = loop->run(100);
    other.join();
    ASSERT_TRUE(run.ok());
    EXPECT_LT(run.value().ticks, 100'000u);
    EXPECT_EQ(device.force_z, 0);
}

TEST_P(Threads, go_on_with_another_object_after_a_reload) {
    ASSERT_TRUE(loop->start().ok());
    wait_for_push();
    loop->stop();
    EXPECT_EQ(device.force_z, 0);
    Simulation other =
        Simulation::create(cube_asset(2, ToolShape::plate, ToolContact::sticking), simulation_config(config))
            .value();
    HapticLoop next = HapticLoop::create(device, other, config).value();
    device.pushed = false;
    ASSERT_TRUE(next.start().ok());
    wait_for_push();
    next.stop();
    EXPECT_EQ(device.force_z, 0);
}

INSTANTIATE_TEST_SUITE_P(Mode, Threads, ::testing::Values(HapticMode::synchronous, HapticMode::two_rate),
                         [](const auto& which) {
                             return which.param == HapticMode::synchronous ? "synchronous" : "two_rate";
                         });

}  // namespace
}  // namespace knead::test
