// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "knead/haptics/haptic_loop.h"
#include "unit/runtime/block_asset.h"

namespace knead::test {

inline double length(const Vec3& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// The object that loops touch here: a cube of 64 cells' edges, 0.1 m, under a plate at z = 0.1 that may
/// leave.
inline Asset touched_cube(ToolContact contact = ToolContact::sticking) {
    return cube_asset(3, ToolShape::plate, contact);
}

/// Nothing of the safety chain acts on ordinary forces: what is rendered is what is written.
inline SafetyConfig open_safety() {
    SafetyConfig safety;
    safety.max_force_n = 1e3;
    safety.slew_n_per_ms = 1e6;
    safety.ramp_n_per_s = 1e6;
    safety.max_torque_nm = 1e3;
    safety.slew_nm_per_ms = 1e6;
    safety.ramp_nm_per_s = 1e6;
    safety.passivity = false;
    return safety;
}

/// A device that is moved by hand: `state` is what it says next, its time goes on by itself unless frozen.
class PlacedDevice final : public Device {
  public:
    PlacedDevice() { state.pose.position_m = {0.05, 0.05, 0.102}; }
    DeviceState read() noexcept override {
        if (!frozen) state.time_s += 1e-3;
        return state;
    }
    void write(const Vec3& force_n, const Vec3& torque_nm) noexcept override {
        force = force_n;
        torque = torque_nm;
    }
    DeviceState state;
    bool frozen = false;
    Vec3 force{}, torque{};
};

/// A two-rate loop in virtual time: results arrive a tick after the step that made them began.
class VirtualTwoRate {
  public:
    VirtualTwoRate(HapticLoop& loop, double simulation_rate_hz, double period_s = 1e-3)
        : loop_(&loop), step_s_(1 / simulation_rate_hz), period_s_(period_s) {}

    HapticTick tick() {
        if (waiting_ && simulates) loop_->publish(result_);
        waiting_ = false;
        const HapticTick tick = loop_->tick(period_s_);
        if (static_cast<double>(ticks_++) * period_s_ >= static_cast<double>(steps_) * step_s_ - 1e-9) {
            ++steps_;
            if (simulates) result_ = loop_->simulate(step_s_);
            waiting_ = true;
        }
        return tick;
    }
    bool simulates = true;

  private:
    HapticLoop* loop_;
    double step_s_, period_s_;
    std::uint64_t ticks_ = 0, steps_ = 0;
    bool waiting_ = false;
    SimulationResult result_;
};

/// Loop and simulation made for each other.
struct Touch {
    explicit Touch(HapticConfig config, Device& device, const Asset& asset = touched_cube())
        : simulation(Simulation::create(asset, simulation_config(config)).value()),
          loop(HapticLoop::create(device, simulation, config).value()),
          two_rate(loop, config.simulation_rate_hz, 1 / config.rate_hz),
          period_s(1 / config.rate_hz),
          synchronous(config.mode == HapticMode::synchronous) {}

    HapticTick tick() { return synchronous ? loop.tick(period_s) : two_rate.tick(); }

    Simulation simulation;
    HapticLoop loop;
    VirtualTwoRate two_rate;
    double period_s;
    bool synchronous;
};

}  // namespace knead::test
