// SPDX-License-Identifier: Apache-2.0
#include "haptics/haptic_side.h"

#include <algorithm>
#include <cmath>

#include "haptics/clock.h"
#include "haptics/quaternion.h"

namespace knead {
namespace {

constexpr double kFarthest_m = 1e3;  ///< from the device's origin: beyond, it is not a hand
// What Simulation::step() takes.
constexpr double kShortestStep_s = 0.25e-3;
constexpr double kLongestStep_s = 20e-3;
/// Synchronous, with rotations: the object's impedance is found this often, and when the touched nodes
/// change.
constexpr int kTicksPerModel = 16;
constexpr double kSmoothing_s = 4e-3;  ///< of the hand's velocity: a count of an encoder in 1 ms is 50 mm/s
/// Times latency and period: hands accelerate. With 2.5, stiff objects are found where the hand never goes.
constexpr double kAhead = 1.5;
constexpr double kLongestAhead_s = 50e-3;
constexpr std::uint32_t kFailed = kStepNotFinite | kStepBadInput;

/// Makes the quaternion exactly unit. @return false if it is not a pose
bool make_good(Pose& pose) noexcept {
    if (!is_unit(pose.orientation_wxyz)) return false;
    const double norm = length(pose.orientation_wxyz);
    for (double& part : pose.orientation_wxyz)
        part /= norm;
    return std::all_of(pose.position_m.begin(), pose.position_m.end(),
                       [](double x) { return std::abs(x) <= kFarthest_m; });
}

Vec3 to_device(const HapticConfig& config, const Vec3& scene) noexcept {
    Vec3 force = force_to_device(config.workspace, scene);
    for (double& component : force)
        component *= config.force_scale;
    return force;
}

}  // namespace

HapticSide::HapticSide(Device& device, Simulation& simulation, const HapticConfig& config,
                       const SafetyChain& safety, Exchange& exchange) noexcept
    : device_(&device),
      simulation_(&simulation),
      config_(config),
      safety_(safety),
      exchange_(&exchange),
      turning_(config.coupling),
      reduced_({config.coupling, config.correction_gain}) {}

HapticTick HapticSide::tick(double dt_s, std::int64_t* step_ns) noexcept {
    HapticTick tick;
    tick.number = ++tick_;
    tick.dt_s = dt_s;
    tick.device = device_->read();
    SafetyInput input;
    if (take_hand(tick.device, dt_s) || has_hand_) {
        const std::int64_t begin = step_ns != nullptr ? now_ns() : 0;
        if (config_.mode == HapticMode::synchronous) {
            step(tick);
            input.step_failed = (tick.step.status & kFailed) != 0;
        } else {
            render(tick);
        }
        if (step_ns != nullptr && config_.mode == HapticMode::synchronous) *step_ns = now_ns() - begin;
    }
    tick.hand = hand_;
    input.force_n = to_device(config_, tick.scene_force_n);
    input.torque_nm = to_device(config_, tick.scene_torque_nm);
    input.pose = tick.device.pose;
    input.dt_s = dt_s;
    input.expected_dt_s = 1 / config_.rate_hz;
    input.sample_age_s = sample_age_s_;
    input.model_age_s = config_.mode == HapticMode::synchronous ? 0 : model_age_s_;
    const SafeForce safe = safety_.apply(input);
    tick.status |= safe.status;
    tick.device_force_n = safe.force_n;
    tick.device_torque_nm = safe.torque_nm;
    device_->write(safe.force_n, safe.torque_nm);
    // Between here and there was nothing that the proxy could have touched on its way.
    if ((safe.status & kHapticPoseJump) != 0) reduced_.reset(hand_);
    return tick;
}

void HapticSide::let_go() noexcept {
    device_->write({}, {});
    safety_.rearm();
}

/// @return whether the sample holds a good pose: it is the hand's then
bool HapticSide::take_hand(const DeviceState& sample, double dt_s) noexcept {
    if (std::isfinite(sample.time_s) && sample.time_s != sample_time_s_) {
        sample_time_s_ = sample.time_s;
        sample_age_s_ = 0;
    } else {
        sample_age_s_ += std::isfinite(dt_s) ? std::max(dt_s, 0.0) : 0;
    }
    Pose pose = sample.pose;
    if (!make_good(pose)) return false;
    hand_ = to_scene(config_.workspace, pose);
    if (!has_hand_) {
        has_hand_ = true;
        turning_.reset(hand_);
        reduced_.reset(hand_);
    }
    return true;
}

/// Synchronous: the object takes the step with the hand.
void HapticSide::step(HapticTick& tick) noexcept {
    const double dt_s = std::clamp(tick.dt_s > 0 ? tick.dt_s : 0.0, kShortestStep_s, kLongestStep_s);
    Pose given = hand_;
    if (turning_.turns()) {
        turning_.advance(hand_, dt_s);
        given.orientation_wxyz = turning_.orientation_wxyz();
    }
    tick.step = simulation_->step(given, dt_s);
    tick.scene_force_n = tick.step.force_n;
    tick.tool = {tick.step.tool_position_m, given.orientation_wxyz};
    tick.scene_torque_nm = tick.step.torque_nm;
    if (!turning_.turns()) return;
    tick.scene_torque_nm = turning_.torque_nm();
    if ((tick.step.status & kFailed) != 0) return turning_.reset(hand_);
    if (--ticks_to_model_ <= 0 || tick.step.touched_nodes != model_touched_) {
        if (!simulation_->local_model(0, model_)) model_ = {};
        ticks_to_model_ = kTicksPerModel;
        model_touched_ = tick.step.touched_nodes;
    }
    turning_.touch(tick.step.torque_nm, model_);
}

/// Two-rate: the newest result, as it is now.
void HapticSide::render(HapticTick& tick) noexcept {
    take_result(tick.dt_s, tick.status);
    const double dt_s = std::clamp(tick.dt_s > 0 ? tick.dt_s : 0.0, kShortestStep_s, kLongestStep_s);
    const Wrench wrench = rendered(dt_s);
    tick.scene_force_n = wrench.force_n;
    tick.scene_torque_nm = wrench.torque_nm;
    tick.tool = reduced_.tool();
    tick.model = result_.number;
    tick.step = result_.step;
    HandSample sample{tick.number, expected_hand(dt_s)};
    sample.pose.orientation_wxyz = tick.tool.orientation_wxyz;
    exchange_->hands.write(sample);
}

void HapticSide::take_result(double dt_s, std::uint32_t& status) noexcept {
    model_age_s_ += std::isfinite(dt_s) ? std::max(dt_s, 0.0) : 0;
    SimulationResult result;
    if (exchange_->results.read(result)) {
        // A failed step is told; the object of the one before goes on, and ages.
        step_failed_ = (result.step.status & kFailed) != 0;
        result_ = result;
        if (result.hand_tick > 0 && result.hand_tick + kTimes > tick_)
            result_age_s_ = time_s_ - tick_times_s_[result.hand_tick % kTimes];
        if (!step_failed_) {
            const bool taken = reduced_.correct(result.model, 1 / config_.simulation_rate_hz);
            if (taken || config_.rendering != LocalRendering::reduced_object) model_age_s_ = 0;
            view_ = linear_view(result.model, config_.coupling.stiffness_n_per_m, result.hand.position_m,
                                result.step.force_n);
        }
    }
    if (step_failed_) status |= kHapticStepFailed;
}

/// Where the hand will be when the result of this pose is about to be replaced: touch that begins until then
/// is known in time. Found only after the hand is in the object, contact would give energy that nobody put
/// in.
/// Not in contact: there the reduced object already knows what comes, and a device that swings at 25 Hz on
/// the coupling would be forecast at several times its amplitude, in the air where it is in the object.
Pose HapticSide::expected_hand(double dt_s) noexcept {
    time_s_ += dt_s;
    tick_times_s_[tick_ % kTimes] = time_s_;
    Pose expected = hand_;
    const double share = dt_s / (dt_s + kSmoothing_s);
    const bool free = config_.rendering == LocalRendering::reduced_object && !reduced_.in_contact();
    const double ahead_s =
        free ? std::min(kAhead * (result_age_s_ + 1 / config_.simulation_rate_hz), kLongestAhead_s) : 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double velocity =
            tick_ == 1 ? 0 : (hand_.position_m[axis] - last_hand_.position_m[axis]) / dt_s;
        hand_velocity_m_per_s_[axis] += share * (velocity - hand_velocity_m_per_s_[axis]);
        expected.position_m[axis] += ahead_s * hand_velocity_m_per_s_[axis];
    }
    last_hand_ = hand_;
    return expected;
}

Wrench HapticSide::rendered(double dt_s) noexcept {
    const Wrench reduced = reduced_.advance(hand_, dt_s);
    if (config_.rendering == LocalRendering::reduced_object) return reduced;
    if (result_.number == 0 || step_failed_) return {};
    if (config_.rendering == LocalRendering::hold) return {result_.step.force_n, {}};
    return {force_at(view_, hand_.position_m), {}};
}

}  // namespace knead
