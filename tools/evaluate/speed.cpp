// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/speed.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "baseline/baseline.h"
#include "baseline/statistics.h"
#include "evaluate/pressing.h"

namespace knead::tools {
namespace {

constexpr double kDtS = 1e-3;
constexpr int kWarmUpSteps = 50;
constexpr int kStepsOfAPress = 250;
constexpr double kSpeedMPerS = 0.1;
constexpr double kTremorHz = 10;
constexpr double kTremorM = 0.3e-3;
constexpr double kSideTremorM = 0.1e-3;
constexpr double kSideTremorHz = 8.5;
/// Radians between the tremors of one press and the next: no two alike.
constexpr double kPhaseStep = 2.4;
constexpr int kStepsInTurn = 10;
/// First steps of a turn bring data back into the caches that the other one used; they are not counted.
constexpr int kNotCounted = 2;

using Clock = std::chrono::steady_clock;

double us_since(Clock::time_point from) {
    return std::chrono::duration<double, std::micro>(Clock::now() - from).count();
}

double tremor(double amplitude_m, double frequency_hz, double time_s, double phase_rad) {
    const double angle = 2 * std::numbers::pi * frequency_hz * time_s;
    return amplitude_m * (std::sin(angle + phase_rad) - std::sin(phase_rad));
}

/// One press after the other, each from rest and with a tremor of its own.
class Presses {
  public:
    Presses(const Pose& rest, const Point& direction, double way_m)
        : rest_(rest),
          direction_(direction),
          side_(std::abs(direction[0]) < 0.9 ? Point{1, 0, 0} : Point{0, 1, 0}),
          way_m_(way_m) {}

    /// Is the step to come the first of a press?
    [[nodiscard]] bool starts() const { return step_ % kStepsOfAPress == 0; }
    Pose next() {
        const double phase = kPhaseStep * (step_ / kStepsOfAPress);
        const double time_s = (step_ % kStepsOfAPress + 1) * kDtS;
        ++step_;
        const Pose pose =
            moved(rest_, direction_,
                  std::min(way_m_, kSpeedMPerS * time_s) - tremor(kTremorM, kTremorHz, time_s, phase));
        return moved(pose, side_, tremor(kSideTremorM, kSideTremorHz, time_s, phase));
    }

  private:
    Pose rest_;
    Point direction_, side_;
    double way_m_;
    int step_ = 0;
};

StepTimes times_of(std::vector<double> us, int not_ok) {
    std::sort(us.begin(), us.end());
    return {baseline::percentile(us, 0.5),   baseline::percentile(us, 0.99),
            baseline::percentile(us, 0.999), us.back(),
            static_cast<int>(us.size()),     not_ok};
}

}  // namespace

StepTimes time_steps(const Asset& asset, std::size_t tool, const Point& direction, double way_m, int steps) {
    Simulation simulation = simulation_of(asset, tool, kDtS);
    Presses presses(simulation.tool_rest_pose(0), direction, way_m);
    std::vector<double> us;
    us.reserve(static_cast<std::size_t>(steps));
    int not_ok = 0;
    for (int k = 0; k < steps + kWarmUpSteps; ++k) {
        if (presses.starts()) simulation.reset();
        const Pose pose = presses.next();
        const auto from = Clock::now();
        const StepResult step = simulation.step(pose, kDtS);
        const double took_us = us_since(from);
        if (k < kWarmUpSteps) continue;
        us.push_back(took_us);
        not_ok += step.status == kStepOk ? 0 : 1;
    }
    return times_of(std::move(us), not_ok);
}

SpeedPair time_in_turns(const Asset& asset, const Point& direction, double way_m, int steps) {
    Simulation simulation = simulation_of(asset, 0, kDtS);
    const baseline::Body body = baseline::make_body(asset);
    baseline::Baseline plain(body);
    const Pose rest = simulation.tool_rest_pose(0);
    Presses presses(rest, direction, way_m), plain_presses(rest, direction, way_m);
    std::vector<double> us, plain_us;
    int not_ok = 0;
    const auto wanted = static_cast<std::size_t>(steps);
    while (us.size() < wanted) {
        for (int k = 0; k < kStepsInTurn; ++k) {
            if (presses.starts()) simulation.reset();
            const Pose pose = presses.next();
            const auto from = Clock::now();
            const StepResult step = simulation.step(pose, kDtS);
            const double took_us = us_since(from);
            if (k >= kNotCounted) us.push_back(took_us);
            not_ok += step.status == kStepOk ? 0 : 1;
        }
        for (int k = 0; k < kStepsInTurn; ++k) {
            if (plain_presses.starts()) plain.reset();
            const Pose pose = plain_presses.next();
            const auto from = Clock::now();
            (void)plain.step(pose, kDtS);
            const double took_us = us_since(from);
            if (k >= kNotCounted) plain_us.push_back(took_us);
        }
    }
    return {times_of(std::move(us), not_ok), times_of(std::move(plain_us), 0)};
}

}  // namespace knead::tools
