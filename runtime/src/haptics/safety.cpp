// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/safety.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "knead/haptics/safety/norm_limit.h"

namespace knead {
namespace {

constexpr double kMsPerS = 1000;
constexpr double kLargest = 1e6;  ///< in any unit here: beyond all that touches a hand, far from overflow
constexpr double kLargestDtRatio = 100;

struct Range {
    double value;
    const char* name;
    bool may_be_zero;
    double largest = kLargest;
};

Status check(const Range& range) {
    const bool fits =
        (range.may_be_zero ? range.value >= 0 : range.value > 0) && range.value <= range.largest;
    if (fits) return Unit{};
    return Error{ErrorCode::invalid_argument,
                 std::string(range.name) + " must be " + (range.may_be_zero ? "at least 0" : "above 0") +
                     " and at most " + std::to_string(range.largest) + ", is " + std::to_string(range.value),
                 "SafetyConfig"};
}

Status check(const PassivityLimits& limits, const std::string& name) {
    for (const Range& range :
         {Range{limits.max_damping, ".max_damping", true}, Range{limits.resolution, ".resolution", false},
          Range{limits.softest, ".softest", false}, Range{limits.travel, ".travel", false},
          Range{limits.max_debt_j, ".max_debt_j", true},
          Range{limits.free_energy_j, ".free_energy_j", true}}) {
        const Status fits = check(Range{range.value, (name + range.name).c_str(), range.may_be_zero});
        if (!fits) return fits;
    }
    return Unit{};
}

Status check(const Watchdog& watchdog, const std::string& name) {
    const std::string zero = name + ".zero_after_s";
    const std::string stale = name + ".stale_after_s";
    const Status fits = check(Range{watchdog.zero_after_s, zero.c_str(), false, Watchdog::kLongestSilence_s});
    if (!fits) return fits;
    return check(Range{watchdog.stale_after_s, stale.c_str(), false, watchdog.zero_after_s});
}

Status check(const SafetyConfig& config) {
    const MotionLimits& motion = config.motion;
    for (const Range& range :
         {Range{config.max_force_n, "max_force_n", false}, Range{config.max_torque_nm, "max_torque_nm", true},
          Range{config.slew_n_per_ms, "slew_n_per_ms", false},
          Range{config.slew_nm_per_ms, "slew_nm_per_ms", false},
          Range{config.ramp_n_per_s, "ramp_n_per_s", false},
          Range{config.ramp_nm_per_s, "ramp_nm_per_s", false},
          Range{motion.max_hand_speed_m_per_s, "motion.max_hand_speed_m_per_s", false},
          Range{motion.max_turn_speed_rad_per_s, "motion.max_turn_speed_rad_per_s", false},
          Range{motion.slack_m, "motion.slack_m", true}, Range{motion.slack_rad, "motion.slack_rad", true},
          Range{motion.max_dt_ratio, "motion.max_dt_ratio", false, kLargestDtRatio}}) {
        const Status fits = check(range);
        if (!fits) return fits;
    }
    if (motion.max_dt_ratio < 1)
        return Error{ErrorCode::invalid_argument, "motion.max_dt_ratio must be at least 1", "SafetyConfig"};
    for (const Status& fits :
         {check(config.device_watchdog, "device_watchdog"), check(config.model_watchdog, "model_watchdog"),
          check(config.force_passivity, "force_passivity"),
          check(config.torque_passivity, "torque_passivity")}) {
        if (!fits) return fits;
    }
    return Unit{};
}

PassivityLimits acting(PassivityLimits limits, bool acts) noexcept {
    if (!acts) limits.max_damping = 0;
    return limits;
}

bool finite(const Vec3& v) noexcept {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

/// A late period earns no larger step.
double step_s(const SafetyInput& input) noexcept {
    return std::min(input.dt_s, input.expected_dt_s);
}

}  // namespace

SafetyChain::SafetyChain(const SafetyConfig& config) noexcept
    : config_(config),
      motion_(config.motion),
      force_{config.max_force_n,
             PassivityController(acting(config.force_passivity, config.passivity), config.max_force_n),
             SlewLimit(config.slew_n_per_ms * kMsPerS), EngageRamp(config.max_force_n, config.ramp_n_per_s)},
      torque_{config.max_torque_nm,
              PassivityController(acting(config.torque_passivity, config.passivity), config.max_torque_nm),
              SlewLimit(config.slew_nm_per_ms * kMsPerS),
              EngageRamp(config.max_torque_nm, config.ramp_nm_per_s)} {}

Result<SafetyChain> SafetyChain::create(const SafetyConfig& config) {
    const Status fits = check(config);
    if (!fits) return fits.error();
    return SafetyChain(config);
}

void SafetyChain::rearm() noexcept {
    motion_.reset();
    restart();
}

void SafetyChain::restart() noexcept {
    for (Port* port : {&force_, &torque_}) {
        port->passivity.reset();
        port->slew.follow({});
        port->ramp.rearm();
        port->written = {};
    }
}

SafeForce SafetyChain::apply(const SafetyInput& input) noexcept {
    const Motion motion = motion_.observe(input.pose, input.dt_s, input.expected_dt_s, input.sample_age_s);
    force_.passivity.observe(force_.written, motion.moved_m, input.dt_s);
    torque_.passivity.observe(torque_.written, motion.turned_rad, input.dt_s);
    SafeForce safe;
    safe.status = motion.status;
    if (input.step_failed) safe.status |= kHapticStepFailed;
    if (!finite(input.force_n) || !finite(input.torque_nm)) safe.status |= kHapticNotFinite;
    const bool known = safe.status == kHapticOk;
    const double share = watchdog_share(input, safe.status);
    if (!known) {
        restart();
        safe.status |= kHapticRamping;
        return safe;
    }
    safe.force_n = run(force_, input.force_n, input, share, safe.status);
    safe.torque_nm = run(torque_, input.torque_nm, input, share, safe.status);
    // Finite in, finite out, as far as is known. This is for what is not known.
    if (finite(safe.force_n) && finite(safe.torque_nm)) return safe;
    restart();
    return {{}, {}, safe.status | kHapticNotFinite | kHapticRamping};
}

double SafetyChain::watchdog_share(const SafetyInput& input, std::uint32_t& status) noexcept {
    // What is written now is held for a period: it must be right until then.
    const double device = config_.device_watchdog.share(input.sample_age_s + input.expected_dt_s);
    const double model = config_.model_watchdog.share(input.model_age_s + input.expected_dt_s);
    if (device < 1) status |= kHapticStaleDevice;
    if (model < 1) status |= kHapticStaleModel;
    const double share = std::min(device, model);
    if (share > share_) {
        for (Port* port : {&force_, &torque_}) {
            port->passivity.reset();
            port->ramp.rearm(norm(port->written));
        }
    }
    share_ = share;
    return share;
}

Vec3 SafetyChain::run(Port& port, const Vec3& wish, const SafetyInput& input, double share,
                      std::uint32_t& status) noexcept {
    port.written = {};
    if (!(port.limit > 0)) return port.written;
    bool shortened = false;
    Vec3 felt = limit_norm(wish, port.limit, &shortened);
    if (shortened) status |= kHapticSaturated;
    const double wished = norm(wish);
    const double given = port.passivity.share(wished);
    if (given < 1) status |= kHapticPassivity;
    for (double& component : felt)
        component *= given;
    const Vec3 damped = port.passivity.damp(felt, wished, input.expected_dt_s, status);
    const double step = step_s(input);
    const Vec3 slewed = port.slew.apply(damped, step, status);
    const Vec3 limited = limit_norm(slewed, port.limit, &shortened);
    if (shortened) status |= kHapticSaturated;
    const Vec3 ramped = port.ramp.apply(limited, step, status);
    port.slew.follow(ramped);
    for (std::size_t axis = 0; axis < 3; ++axis)
        port.written[axis] = share * ramped[axis];
    return port.written;
}

}  // namespace knead
