// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "knead/haptics/haptic_loop.h"

namespace knead::tools {

/// Steps and arrivals of a two-rate loop in virtual time: a step begins every period, its result arrives a
/// latency later. In every haptic period: arrive(), the tick, step().
class VirtualSimulation {
  public:
    /// @param latency_s from the start of a step to the arrival of its result, >= 0
    VirtualSimulation(HapticLoop& loop, double period_s, double latency_s)
        : loop_(loop), period_s_(period_s), latency_s_(latency_s) {}

    /// Publishes what is due. @param now_s must not go back between calls
    void arrive(double now_s);
    /// Does the steps that begin until now. @param observe called after each
    void step(double now_s, const std::function<void(const SimulationResult&)>& observe = {});

  private:
    struct Due {
        double at_s;
        SimulationResult result;
    };
    [[nodiscard]] double next_s() const { return static_cast<double>(steps_) * period_s_; }

    HapticLoop& loop_;
    double period_s_, latency_s_;
    std::uint64_t steps_ = 0;
    std::deque<Due> due_;
};

}  // namespace knead::tools
