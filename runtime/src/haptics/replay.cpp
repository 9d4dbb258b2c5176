// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <string>
#include <type_traits>

#include "knead/haptics/session.h"

namespace knead {
namespace {

/// Says again what a device said in a session.
class RecordedDevice final : public Device {
  public:
    explicit RecordedDevice(const SessionLog::Ticks& ticks) : ticks_(ticks) {}

    DeviceState read() noexcept override {
        DeviceState sample;
        if (next_ == ticks_.number.size()) return sample;
        sample.time_s = ticks_.device_time_s[next_];
        sample.pose.position_m = ticks_.device_position_m[next_];
        sample.pose.orientation_wxyz = ticks_.device_orientation_wxyz[next_];
        sample.velocity_m_per_s = ticks_.device_velocity_m_per_s[next_];
        sample.buttons = ticks_.device_buttons[next_];
        ++next_;
        return sample;
    }
    void write(const Vec3& /*force_n*/, const Vec3& /*torque_n_m*/) noexcept override {}

  private:
    const SessionLog::Ticks& ticks_;
    std::size_t next_ = 0;
};

std::string text_of(double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%.17g (0x%016llx)", value,
                  static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(value)));
    return text;
}
template <class T>
std::string text_of(T value) {
    return std::to_string(value);
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
template <class T>
bool same_bits(T a, T b) {
    return a == b;
}

/// Notes the first difference.
class Comparison {
  public:
    explicit Comparison(ReplayReport& report) : report_(report) {}
    void set_row(const char* what, std::uint64_t number) {
        row_ = std::string(what) + " " + std::to_string(number);
    }

    template <class T>
    void check(const std::string& name, T found, T recorded) {
        if (!report_.same || same_bits(found, recorded)) return;
        report_.same = false;
        report_.first_difference =
            row_ + ": " + name + " is " + text_of(found) + ", recorded " + text_of(recorded);
    }
    template <class T, std::size_t N>
    void check(const char* name, const std::array<T, N>& found, const std::array<T, N>& recorded) {
        for (std::size_t i = 0; i < N; ++i)
            if (!same_bits(found[i], recorded[i]))
                check(name + ("[" + std::to_string(i) + "]"), found[i], recorded[i]);
    }

  private:
    ReplayReport& report_;
    std::string row_;
};

void compare(const HapticTick& tick, const SessionLog::Ticks& t, std::size_t i, Comparison& comparison) {
    comparison.set_row("tick", t.number[i]);
    comparison.check("number", tick.number, t.number[i]);
    comparison.check("used_step", tick.model, t.used_step[i]);
    comparison.check("tool_position_m", tick.tool.position_m, t.tool_position_m[i]);
    comparison.check("tool_orientation_wxyz", tick.tool.orientation_wxyz, t.tool_orientation_wxyz[i]);
    comparison.check("scene_force_n", tick.scene_force_n, t.scene_force_n[i]);
    comparison.check("scene_torque_nm", tick.scene_torque_nm, t.scene_torque_nm[i]);
    comparison.check("force_n", tick.device_force_n, t.force_n[i]);
    comparison.check("torque_nm", tick.device_torque_nm, t.torque_nm[i]);
    comparison.check("status", tick.status, t.status[i]);
    comparison.check("step_status", tick.step.status, t.step_status[i]);
    comparison.check("touched_nodes", tick.step.touched_nodes, t.touched_nodes[i]);
}

void compare(const SimulationResult& result, const SessionLog::Steps& s, std::size_t i,
             Comparison& comparison) {
    comparison.set_row("step", s.number[i]);
    comparison.check("number", result.number, s.number[i]);
    comparison.check("hand_tick", result.hand_tick, s.hand_tick[i]);
    comparison.check("force_n", result.step.force_n, s.force_n[i]);
    comparison.check("torque_nm", result.step.torque_nm, s.torque_nm[i]);
    comparison.check("status", result.step.status, s.status[i]);
    comparison.check("touched_nodes", result.step.touched_nodes, s.touched_nodes[i]);
    comparison.check("solver_iterations", result.step.solver_iterations, s.solver_iterations[i]);
}

/// What came before the first recorded row cannot be run again.
Status check_whole(const SessionLog& log) {
    if (Status valid = validate(log); !valid.ok()) return valid;
    const auto whole = [](const std::vector<std::uint64_t>& number) {
        for (std::size_t i = 0; i < number.size(); ++i)
            if (number[i] != i + 1) return false;
        return true;
    };
    if (!whole(log.ticks.number) || !whole(log.steps.number))
        return Error{ErrorCode::invalid_data, "the log leaves ticks or steps out: it cannot be run again",
                     "/knead/session"};
    return Unit{};
}

/// Runs the events of a log in an order that gives what the recorded order gave: a step right after the tick
/// whose pose it used, its arrival right before the first tick that used it. A result that no tick used was
/// replaced by a newer one in time and is stepped, but never published.
class Replay {
  public:
    Replay(const SessionLog& log, HapticLoop& loop, ReplayReport& report)
        : log_(log), loop_(loop), report_(report), comparison_(report) {}

    void run() {
        simulate_from(0);
        for (std::size_t i = 0; i < log_.ticks.number.size() && report_.same; ++i) {
            publish(log_.ticks.used_step[i]);
            compare(loop_.tick(log_.ticks.dt_s[i]), log_.ticks, i, comparison_);
            ++report_.ticks;
            simulate_from(log_.ticks.number[i]);
        }
    }

  private:
    void simulate_from(std::uint64_t tick) {
        const SessionLog::Steps& steps = log_.steps;
        for (; next_step_ < steps.number.size() && steps.hand_tick[next_step_] == tick && report_.same;
             ++next_step_) {
            results_.push_back(loop_.simulate(steps.dt_s[next_step_]));
            compare(results_.back(), steps, next_step_, comparison_);
            ++report_.steps;
        }
    }

    void publish(std::uint64_t step) {
        if (step == published_) return;
        while (results_.front().number < step)
            results_.pop_front();
        loop_.publish(results_.front());
        published_ = step;
    }

    const SessionLog& log_;
    HapticLoop& loop_;
    ReplayReport& report_;
    Comparison comparison_;
    std::deque<SimulationResult> results_;  ///< stepped, and not older than the one in use
    std::size_t next_step_ = 0;
    std::uint64_t published_ = 0;
};

}  // namespace

Result<ReplayReport> replay(const SessionLog& log, Simulation& simulation) {
    if (Status whole = check_whole(log); !whole.ok()) return whole.error();
    const Result<HapticConfig> config = haptic_config_of(log);
    if (!config.ok()) return config.error();
    RecordedDevice device(log.ticks);
    Result<HapticLoop> loop = HapticLoop::create(device, simulation, config.value());
    if (!loop.ok()) return loop.error();
    ReplayReport report;
    Replay(log, loop.value(), report).run();
    return report;
}

}  // namespace knead
