// SPDX-License-Identifier: Apache-2.0
// A machine that stops for a while in the middle of a press, in virtual time: what the force gives to the
// hand when it comes back. The energy is the simulated hand's own account of true motion, exact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>

#include "knead/haptics/simulated_operator.h"
#include "unit/haptics/loop_parts.h"

namespace knead::test {
namespace {

/// Twice the passivity controller's free energy, over which the force fades, and a hand's way in one period:
/// 0.1 mJ at 1 N and 0.1 m/s.
constexpr double kEpsilonJ = 5e-4;
constexpr double kUnloadedN = 0.033;  ///< a hundredth of the full force: the contact is left
constexpr double kPeriodS = 1e-3;
constexpr int kPresses = 240;

/// A hand that goes on while the machine does not: the last force is held for `periods`.
class StalledHand final : public Device {
  public:
    explicit StalledHand(const OperatorConfig& config) : hand_(SimulatedOperator::create(config).value()) {}
    DeviceState read() noexcept override {
        for (; periods > 1; --periods)
            (void)hand_.read();
        return hand_.read();
    }
    void write(const Vec3& force_n, const Vec3& torque_nm) noexcept override {
        hand_.write(force_n, torque_nm);
    }
    [[nodiscard]] double given_j() const { return hand_.energy().port_j; }
    int periods = 1;

  private:
    SimulatedOperator hand_;
};

/// Two presses in and out, with everything about it drawn at random from a seed.
class StalledPress {
  public:
    StalledPress(std::uint64_t seed, HapticMode mode, bool passivity) : random_(seed) {
        HapticConfig config;
        config.mode = mode;
        config.workspace.rotation_wxyz = {1, 0, 0, 0};
        config.workspace.offset_m = {0.05, 0.05, 0.1};
        config.coupling.damping_n_s_per_m = 1;
        config.safety.passivity = passivity;
        const PaletteEntry material{uniform(22e3, 110e3), 0.3, 1000};
        device_ = std::make_unique<StalledHand>(hand());
        touch_ = std::make_unique<Touch>(config, *device_,
                                         cube_asset(2, ToolShape::plate, ToolContact::sticking, material));
    }

    /// @return the most that was given after any restart until that contact was left, J
    double most_given_j() {
        double stall_s = uniform(0.3, 1.5), restart_j = 0, most_j = 0;
        bool recovering = false;
        for (double t = 0; t < kEndS;) {
            const int periods = t > stall_s ? 10 + static_cast<int>(random_() % 31) : 1;
            const HapticTick tick = periods > 1 ? stall(periods) : touch_->tick();
            t += periods * kPeriodS;
            if (periods > 1) {
                EXPECT_EQ(tick.device_force_n, Vec3{});
                EXPECT_TRUE(tick.status & kHapticTimeJump);
                stall_s = t + uniform(0.2, 1.5);
                recovering = true;
                restart_j = device_->given_j();
            }
            if (recovering) most_j = std::max(most_j, device_->given_j() - restart_j);
            if (length(tick.scene_force_n) < kUnloadedN) recovering = false;
        }
        return most_j;
    }

  private:
    static constexpr double kEndS = 2.8;

    double uniform(double from, double to) {
        return from + (to - from) * static_cast<double>(random_() >> 11U) * 0x1.0p-53;
    }
    OperatorConfig hand() {
        OperatorConfig hand;
        hand.position_resolution_m = 2e-5;
        hand.hand_mass_kg = uniform(0.05, 0.15);
        hand.hand_stiffness_n_per_m = uniform(150, 500);
        hand.hand_damping_n_s_per_m = uniform(2, 6);
        Pose start, deep;
        start.position_m[2] = 0.004;
        deep.position_m[2] = -uniform(0.003, 0.010);
        hand.path = {{0.1, start}, {0.3, deep}, {1.1, deep}, {1.3, start},
                     {1.5, start}, {1.7, deep}, {2.5, deep}, {2.7, start}};
        return hand;
    }
    HapticTick stall(int periods) {
        device_->periods = periods;
        return touch_->loop.tick(periods * kPeriodS);
    }

    std::mt19937_64 random_;
    std::unique_ptr<StalledHand> device_;
    std::unique_ptr<Touch> touch_;
};

struct Stall : ::testing::TestWithParam<HapticMode> {};

TEST_P(Stall, in_a_press_and_the_force_that_comes_back_gives_no_more_than_epsilon) {
    double uncontrolled_j = 0;
    for (std::uint64_t seed = 1; seed <= kPresses; ++seed) {
        EXPECT_LE(StalledPress(seed, GetParam(), true).most_given_j(), kEpsilonJ) << seed;
        if (seed <= 20)
            uncontrolled_j = std::max(uncontrolled_j, StalledPress(seed, GetParam(), false).most_given_j());
    }
    EXPECT_GT(uncontrolled_j, 10 * kEpsilonJ);  // there is something to hold back
}

INSTANTIATE_TEST_SUITE_P(Mode, Stall, ::testing::Values(HapticMode::synchronous, HapticMode::two_rate),
                         [](const auto& which) {
                             return which.param == HapticMode::synchronous ? "synchronous" : "two_rate";
                         });

}  // namespace
}  // namespace knead::test
