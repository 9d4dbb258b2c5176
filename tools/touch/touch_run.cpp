// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/touch_run.h"

#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "common/error.h"
#include "knead/haptics/session.h"
#include "touch/snapshot.h"
#include "touch/virtual_simulation.h"

namespace knead::tools {
namespace {

/// Room in the log beyond the time asked for: the loop goes on until it is stopped.
constexpr double kSpare_s = 1;

/// What sees the ticks and steps of a run: on the loop's threads in real time, so it neither allocates nor
/// locks.
class Witness {
  public:
    Witness(const TouchSetup& setup, SessionRecorder* recorder)
        : meter_(setup.line.rest.position_m, setup.line.direction), recorder_(recorder) {}

    void see(const HapticTick& tick) noexcept {
        meter_.see(tick);
        snapshot_.write(meter_.totals());
        if (recorder_ != nullptr) recorder_->record(tick);
    }
    void see(const SimulationResult& result) noexcept {
        if (recorder_ != nullptr) recorder_->record(result);
    }
    [[nodiscard]] TouchTotals totals() const noexcept { return snapshot_.read(); }

  private:
    TouchMeter meter_;
    Snapshot<TouchTotals> snapshot_;
    SessionRecorder* recorder_;
};

bool stopped(const TouchListener& listener) {
    return listener.interrupted && listener.interrupted();
}

/// @return whether it was interrupted
bool run_virtual(HapticLoop& loop, const TouchSetup& setup, Witness& witness, const TouchListener& listener) {
    const bool two_rate = setup.haptic.mode == HapticMode::two_rate;
    const double period_s = 1 / setup.haptic.rate_hz;
    const auto shown_every =
        static_cast<std::uint64_t>(std::max(1.0, std::round(listener.show_period_s / period_s)));
    const double step_s = 1 / setup.haptic.simulation_rate_hz;
    VirtualSimulation simulation(loop, step_s, kLatencyPeriods * step_s);
    for (std::uint64_t i = 0; i < setup.tick_count(); ++i) {
        if (stopped(listener)) return true;
        const double now_s = static_cast<double>(i) * period_s;
        if (two_rate) simulation.arrive(now_s);
        witness.see(loop.tick(period_s));
        if (two_rate) simulation.step(now_s, [&](const SimulationResult& result) { witness.see(result); });
        if (listener.show && (i + 1) % shown_every == 0) listener.show(witness.totals(), {});
    }
    return false;
}

bool run_real(HapticLoop& loop, const TouchSetup& setup, Witness& witness, const TouchListener& listener) {
    using Seconds = std::chrono::duration<double>;
    value_or_throw(loop.start([&](const HapticTick& tick) { witness.see(tick); },
                              [&](const SimulationResult& result) { witness.see(result); }));
    const auto start = std::chrono::steady_clock::now();
    bool interrupted = false;
    for (;;) {
        const double left_s = setup.seconds - Seconds(std::chrono::steady_clock::now() - start).count();
        interrupted = stopped(listener);
        if (interrupted || left_s <= 0) break;
        std::this_thread::sleep_for(Seconds(std::min(left_s, listener.show_period_s)));
        if (listener.show) listener.show(witness.totals(), loop.statistics());
    }
    loop.stop();
    return interrupted;
}

SessionRecorder make_recorder(const TouchSetup& setup, const std::string& hash, bool with_log) {
    SessionCapacity capacity{0, 0};
    if (with_log) {
        const double seconds = setup.seconds + kSpare_s;
        capacity.ticks = static_cast<std::size_t>(seconds * setup.haptic.rate_hz);
        if (setup.haptic.mode == HapticMode::two_rate)
            capacity.steps = static_cast<std::size_t>(seconds * setup.haptic.simulation_rate_hz);
    }
    return value_or_throw(SessionRecorder::create(setup.haptic, setup.simulation, hash, capacity));
}

}  // namespace

TouchOutcome run_touch(const Asset& asset, const std::string& asset_content_hash, const TouchSetup& setup,
                       Device& device, bool with_log, const TouchListener& listener) {
    Simulation simulation = value_or_throw(Simulation::create(asset, setup.simulation));
    HapticLoop loop = value_or_throw(HapticLoop::create(device, simulation, setup.haptic));
    SessionRecorder recorder = make_recorder(setup, asset_content_hash, with_log);
    Witness witness(setup, with_log ? &recorder : nullptr);

    TouchOutcome outcome;
    if (setup.request.virtual_time) {
        outcome.interrupted = run_virtual(loop, setup, witness, listener);
        device.write({}, {});
    } else {
        outcome.interrupted = run_real(loop, setup, witness, listener);
        outcome.statistics = loop.statistics();
    }
    outcome.totals = witness.totals();
    SessionLog log = recorder.log();
    outcome.settings = log.settings;
    if (with_log) outcome.log = std::move(log);
    return outcome;
}

}  // namespace knead::tools
