// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/virtual_simulation.h"

namespace knead::tools {
namespace {

constexpr double kTie_s = 1e-9;  ///< moments this near are the same

}  // namespace

void VirtualSimulation::arrive(double now_s) {
    for (; !due_.empty() && due_.front().at_s <= now_s + kTie_s; due_.pop_front())
        loop_.publish(due_.front().result);
}

void VirtualSimulation::step(double now_s, const std::function<void(const SimulationResult&)>& observe) {
    for (; next_s() <= now_s + kTie_s; ++steps_) {
        due_.push_back({next_s() + latency_s_, loop_.simulate(period_s_)});
        if (observe) observe(due_.back().result);
    }
}

}  // namespace knead::tools
