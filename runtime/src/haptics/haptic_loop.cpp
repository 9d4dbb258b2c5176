// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/haptic_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "haptics/quaternion.h"

namespace knead {
namespace {

constexpr double kSlowest_hz = 50;
constexpr double kFastest_hz = 4000;
constexpr double kUnitTolerance = 1e-3;

Vec3 to_device(const HapticConfig& config, const Vec3& scene_force_n) noexcept {
    Vec3 force = force_to_device(config.workspace, scene_force_n);
    for (double& component : force)
        component *= config.force_scale;
    return force;
}

/// Shortens to the limit and keeps the direction: a clip per axis would bend it.
void limit_norm(double max_force_n, Vec3& force, std::uint32_t& status) noexcept {
    const double norm = std::hypot(force[0], force[1], force[2]);
    if (!(norm > max_force_n) || std::isinf(norm)) return;
    for (double& component : force)
        component *= max_force_n / norm;
    status |= kHapticSaturated;
}

void zero_if_not_finite(Vec3& force, std::uint32_t& status) noexcept {
    if (std::isfinite(force[0]) && std::isfinite(force[1]) && std::isfinite(force[2])) return;
    force = {};
    status |= kHapticNotFinite;
}

bool unit(const QuaternionWxyz& q) {
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    return std::abs(norm - 1) <= kUnitTolerance;
}

Error bad(const std::string& what) {
    return Error{ErrorCode::invalid_argument, what, "HapticLoop"};
}

}  // namespace

HapticLoop::HapticLoop(Device& device, Simulation& simulation, const HapticConfig& config) noexcept
    : device_(&device), simulation_(&simulation), config_(config) {}

Result<HapticLoop> HapticLoop::create(Device& device, Simulation& simulation, const HapticConfig& config) {
    if (simulation.tool_count() != 1)
        return bad("the simulation must have one tool, has " + std::to_string(simulation.tool_count()));
    const WorkspaceMap& map = config.workspace;
    if (!(map.scale > 0 && std::isfinite(map.scale)))
        return bad("workspace.scale must be finite and above 0");
    if (!unit(map.rotation_wxyz)) return bad("workspace.rotation_wxyz must be a unit quaternion");
    for (const double offset : map.offset_m) {
        if (!std::isfinite(offset)) return bad("workspace.offset_m must be finite");
    }
    if (!(config.force_scale >= 0 && std::isfinite(config.force_scale))) {
        return bad("force_scale must be finite and not negative");
    }
    if (!(config.max_force_n > 0 && std::isfinite(config.max_force_n))) {
        return bad("max_force_n must be finite and above 0");
    }
    return HapticLoop(device, simulation, config);
}

HapticTick HapticLoop::tick(double dt_s) noexcept {
    HapticTick tick;
    tick.device = device_->read();
    tick.hand = to_scene(config_.workspace, tick.device.pose);
    tick.step = simulation_->step(tick.hand, dt_s);
    tick.device_force_n = to_device(config_, tick.step.force_n);
    limit_norm(config_.max_force_n, tick.device_force_n, tick.status);
    zero_if_not_finite(tick.device_force_n, tick.status);
    device_->write(tick.device_force_n, {});
    return tick;
}

Result<RunStatistics> HapticLoop::run(double seconds, double rate_hz,
                                      const std::function<void(const HapticTick&)>& observe) {
    if (!(seconds >= 0 && std::isfinite(seconds))) return bad("seconds must be finite and not negative");
    if (!(rate_hz >= kSlowest_hz && rate_hz <= kFastest_hz)) return bad("rate_hz must be 50 to 4000");
    using Clock = std::chrono::steady_clock;
    const auto period =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate_hz));
    const auto wanted = static_cast<std::uint64_t>(std::llround(seconds * rate_hz));
    RunStatistics statistics;
    auto start = Clock::now();
    while (statistics.ticks < wanted) {
        const HapticTick tick = this->tick(1 / rate_hz);
        if (observe) observe(tick);
        const auto end = Clock::now();
        ++statistics.ticks;
        statistics.step_status |= tick.step.status;
        statistics.haptic_status |= tick.status;
        statistics.longest_tick_s =
            std::max(statistics.longest_tick_s, std::chrono::duration<double>(end - start).count());
        start += period;
        if (end > start) {
            ++statistics.misses;
            start = end;
        } else {
            std::this_thread::sleep_until(start);
        }
    }
    device_->write({}, {});
    return statistics;
}

}  // namespace knead
