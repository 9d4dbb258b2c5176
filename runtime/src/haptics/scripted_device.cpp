// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/scripted_device.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace knead {
namespace {

constexpr double kMostSamples = 1e7;

/// How far along its travel a press is, and how fast: share and share per second.
struct Progress {
    double share = 0;
    double rate = 0;
};

Progress progress_at(const PressScript& script, double time_s) {
    double t = time_s - script.wait_s;
    if (t < 0) return {0, 0};
    if (t < script.press_s) return {t / script.press_s, 1 / script.press_s};
    t -= script.press_s + script.hold_s;
    if (t < 0 || script.release_s == 0) return {1, 0};
    if (t < script.release_s) return {1 - t / script.release_s, -1 / script.release_s};
    return {0, 0};
}

}  // namespace

std::vector<DeviceState> press_samples(const PressScript& script) {
    double seconds = 0;
    for (const double part :
         {script.wait_s, script.press_s, script.hold_s, script.release_s, script.rest_s}) {
        if (!(part >= 0)) return {};
        seconds += part;
    }
    if (script.release_s == 0) seconds -= script.rest_s;
    if (!(script.rate_hz > 0) || !(seconds * script.rate_hz < kMostSamples)) return {};
    std::vector<DeviceState> samples(static_cast<std::size_t>(std::floor(seconds * script.rate_hz)) + 1);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        DeviceState& sample = samples[i];
        sample.time_s = static_cast<double>(i) / script.rate_hz;
        sample.pose = script.start;
        const Progress progress = progress_at(script, sample.time_s);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sample.pose.position_m[axis] += progress.share * script.travel_m[axis];
            sample.velocity_m_per_s[axis] = progress.rate * script.travel_m[axis];
        }
    }
    return samples;
}

ScriptedDevice::ScriptedDevice(std::vector<DeviceState> samples) : samples_(std::move(samples)) {
    forces_.reserve(samples_.size());
    torques_.reserve(samples_.size());
    if (samples_.size() > 1) period_s_ = samples_.back().time_s - samples_[samples_.size() - 2].time_s;
    rewind();
}

DeviceState ScriptedDevice::read() noexcept {
    if (!finished()) return samples_[next_++];
    resting_.time_s += period_s_;
    return resting_;
}

void ScriptedDevice::write(const Vec3& force_n, const Vec3& torque_n_m) noexcept {
    if (forces_.size() == samples_.size()) return;
    forces_.push_back(force_n);
    torques_.push_back(torque_n_m);
}

void ScriptedDevice::rewind() noexcept {
    next_ = 0;
    forces_.clear();
    torques_.clear();
    resting_ = samples_.empty() ? DeviceState{} : samples_.back();
    resting_.velocity_m_per_s = {};
}

}  // namespace knead
