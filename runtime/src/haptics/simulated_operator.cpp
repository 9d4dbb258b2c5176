// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/simulated_operator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "haptics/hand_path.h"
#include "haptics/quaternion.h"

namespace knead {
namespace {

constexpr double kLongestPiece = 50e-6;  ///< seconds: dry friction acts this often
constexpr double kUnitTolerance = 1e-6;  ///< of a quaternion's norm

double dot(const Vec3& a, const Vec3& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double norm(const Vec3& a) noexcept {
    return std::sqrt(dot(a, a));
}

bool finite(const Vec3& a) noexcept {
    return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

/// What a motor makes of a demand: at most `limit` long, zero: no limit.
Vec3 limited(const Vec3& demand, double limit) noexcept {
    if (!finite(demand)) return {};
    const double length = norm(demand);
    if (limit <= 0 || length <= limit) return demand;
    const double share = limit / length;
    return {share * demand[0], share * demand[1], share * demand[2]};
}

double rounded(double value, double resolution) noexcept {
    return resolution > 0 ? std::floor(value / resolution + 0.5) * resolution : value;
}

struct Range {
    const char* name;
    double value, least, most;
};

std::string out_of_range(const OperatorConfig& c) {
    constexpr double kMuch = 1e6;
    const Range ranges[] = {
        {"device_mass_kg", c.device_mass_kg, 0, kMuch},
        {"device_damping_n_s_per_m", c.device_damping_n_s_per_m, 0, kMuch},
        {"coulomb_friction_n", c.coulomb_friction_n, 0, kMuch},
        {"position_resolution_m", c.position_resolution_m, 0, 1},
        {"angle_resolution_rad", c.angle_resolution_rad, 0, 1},
        {"max_force_n", c.max_force_n, 0, kMuch},
        {"max_torque_nm", c.max_torque_nm, 0, kMuch},
        {"hand_mass_kg", c.hand_mass_kg, 0, kMuch},
        {"hand_stiffness_n_per_m", c.hand_stiffness_n_per_m, 0, kMuch},
        {"hand_damping_n_s_per_m", c.hand_damping_n_s_per_m, 0, kMuch},
        {"inertia_kg_m2", c.inertia_kg_m2, 0, kMuch},
        {"hand_stiffness_nm_per_rad", c.hand_stiffness_nm_per_rad, 0, kMuch},
        {"hand_damping_nm_s_per_rad", c.hand_damping_nm_s_per_rad, 0, kMuch},
        {"period_s", c.period_s, 1e-4, 1e-2},
        {"jitter_periods", c.jitter_periods, 0, 0.9},
        {"force_delay_periods", c.force_delay_periods, 0, 64},
        {"velocity_window", static_cast<double>(c.velocity_window), 1, 64},
    };
    for (const Range& range : ranges)
        if (!(range.value >= range.least && range.value <= range.most))
            return std::string(range.name) + " is " + std::to_string(range.value) + ", not between " +
                   std::to_string(range.least) + " and " + std::to_string(range.most);
    return {};
}

/// The pieces must resolve what swings: the series and the semi-implicit turns count on it.
std::string too_stiff(const OperatorConfig& c) {
    const double mass = c.device_mass_kg + c.hand_mass_kg, h = kLongestPiece;
    if (!(mass > 0)) return "device_mass_kg and hand_mass_kg are both zero";
    const double damping = c.hand_damping_n_s_per_m + c.device_damping_n_s_per_m;
    if (c.hand_stiffness_n_per_m * h * h > mass || damping * h > mass)
        return "hand_stiffness_n_per_m or the damping is too large for the mass at the pieces of 50 us";
    if (c.inertia_kg_m2 > 0 && (c.hand_stiffness_nm_per_rad * h * h > c.inertia_kg_m2 ||
                                c.hand_damping_nm_s_per_rad * h > c.inertia_kg_m2))
        return "hand_stiffness_nm_per_rad or hand_damping_nm_s_per_rad is too large for inertia_kg_m2 at the "
               "pieces of 50 us";
    return {};
}

std::string bad_path(const std::vector<HandTarget>& path) {
    for (std::size_t i = 0; i < path.size(); ++i) {
        const auto& q = path[i].pose.orientation_wxyz;
        const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        const std::string where = "path[" + std::to_string(i) + "]";
        if (!std::isfinite(path[i].time_s) || (i > 0 && path[i].time_s < path[i - 1].time_s))
            return where + ": the time goes back or is not finite";
        if (!finite(path[i].pose.position_m) || !(std::abs(length - 1) <= kUnitTolerance))
            return where + ": not a pose";
    }
    return {};
}

}  // namespace

/// Exact motion of y'' = -stiffness y - damping y' + a + jerk t over one piece, from the series of the matrix
/// exponential and its integrals; y and dt y' as rows, so that the matrix has no units.
struct SimulatedOperator::Oscillator {
    std::array<double, 4> state{};     ///< of (y, dt y') at the end, from the start
    std::array<double, 2> constant{};  ///< of dt^2 a
    std::array<double, 2> ramp{};      ///< of dt^3 jerk

    Oscillator(double stiffness_per_s2, double damping_per_s, double dt_s) noexcept {
        // create() keeps the matrix below 2 in norm: 2^24 / 24! is far below the precision of a double.
        constexpr int kTerms = 24;
        const double k = stiffness_per_s2 * dt_s * dt_s, b = damping_per_s * dt_s;
        std::array<double, 4> power{1, 0, 0, 1};  // of the matrix, divided by the term's factorial
        for (int i = 0; i < kTerms; ++i) {
            for (std::size_t j = 0; j < 4; ++j)
                state[j] += power[j];
            for (std::size_t row = 0; row < 2; ++row) {
                constant[row] += power[2 * row + 1] / (i + 1);
                ramp[row] += power[2 * row + 1] / ((i + 1) * (i + 2));
            }
            const double next = 1.0 / (i + 1);
            power = {next * (-k * power[1]), next * (power[0] - b * power[1]), next * (-k * power[3]),
                     next * (power[2] - b * power[3])};
        }
    }
};

Result<SimulatedOperator> SimulatedOperator::create(const OperatorConfig& config) {
    for (const std::string& problem : {out_of_range(config), too_stiff(config), bad_path(config.path)})
        if (!problem.empty()) return Error{ErrorCode::invalid_argument, problem, "OperatorConfig"};
    return SimulatedOperator(config);
}

SimulatedOperator::SimulatedOperator(const OperatorConfig& config)
    : config_(config),
      random_(config.seed),
      pending_(static_cast<std::size_t>(std::ceil(config.force_delay_periods)) + 3),
      window_(std::size_t{config.velocity_window} + 1) {
    state_.pose = wish_at(config_.path, path_at_, 0).pose;
}

double SimulatedOperator::jittered() noexcept {
    const double time_s = static_cast<double>(samples_) * config_.period_s;
    if (samples_ == 0 || config_.jitter_periods == 0) return time_s;
    constexpr double kUnit = 0x1p-53;
    const double share = static_cast<double>(random_() >> 11) * kUnit - 0.5;
    return time_s + share * config_.jitter_periods * config_.period_s;
}

DeviceState SimulatedOperator::read() noexcept {
    const double time_s = jittered();
    advance_to(time_s);
    state_.time_s = time_s;
    return measured();
}

DeviceState SimulatedOperator::measured() noexcept {
    DeviceState sample;
    sample.time_s = state_.time_s;
    sample.pose.orientation_wxyz = state_.pose.orientation_wxyz;
    if (config_.angle_resolution_rad > 0) {
        Vec3 turn = rotation_vector(state_.pose.orientation_wxyz);
        for (double& angle : turn)
            angle = rounded(angle, config_.angle_resolution_rad);
        sample.pose.orientation_wxyz = rotation_of(turn);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        sample.pose.position_m[axis] = rounded(state_.pose.position_m[axis], config_.position_resolution_m);
    window_[samples_ % window_.size()] = {sample.time_s, sample.pose.position_m};
    const std::uint64_t back = std::min<std::uint64_t>(samples_, config_.velocity_window);
    if (back > 0) {
        const Sample& earlier = window_[(samples_ - back) % window_.size()];
        for (std::size_t axis = 0; axis < 3; ++axis)
            sample.velocity_m_per_s[axis] =
                (sample.pose.position_m[axis] - earlier.position_m[axis]) / (sample.time_s - earlier.time_s);
    }
    ++samples_;
    return sample;
}

void SimulatedOperator::write(const Vec3& force_n, const Vec3& torque_n_m) noexcept {
    const double at_s = state_.time_s + config_.force_delay_periods * config_.period_s;
    // Several writes without a read() in between can fill the ring: the last one counts.
    if (pending_count_ == pending_.size()) --pending_count_;
    pending_[(first_pending_ + pending_count_) % pending_.size()] = {
        at_s, limited(force_n, config_.max_force_n), limited(torque_n_m, config_.max_torque_nm)};
    ++pending_count_;
    advance_to(state_.time_s);  // without a delay it acts from now on
}

void SimulatedOperator::advance_to(double time_s) noexcept {
    while (pending_count_ > 0 && pending_[first_pending_].time_s <= time_s) {
        const PendingForce& next = pending_[first_pending_];
        advance_held(next.time_s);
        state_.force_n = next.force_n;
        state_.torque_nm = next.torque_nm;
        first_pending_ = (first_pending_ + 1) % pending_.size();
        --pending_count_;
    }
    advance_held(time_s);
}

void SimulatedOperator::advance_held(double time_s) noexcept {
    while (state_.time_s < time_s) {
        const double until_s = std::min(time_s, next_change_s(config_.path, path_at_, state_.time_s));
        const double from_s = state_.time_s;
        const double pieces = std::max(1.0, std::ceil((until_s - from_s) / kLongestPiece - 1e-6));
        const double dt_s = (until_s - from_s) / pieces, mass = config_.device_mass_kg + config_.hand_mass_kg;
        const double damping = config_.hand_damping_n_s_per_m + config_.device_damping_n_s_per_m;
        const Oscillator motion(config_.hand_stiffness_n_per_m / mass, damping / mass, dt_s);
        for (double piece = 0; piece < pieces; ++piece) {
            step(motion, dt_s);
            state_.time_s = from_s + (piece + 1) * dt_s;
        }
        state_.time_s = until_s;
    }
}

void SimulatedOperator::step(const Oscillator& motion, double dt_s) noexcept {
    const HandWish wish = wish_at(config_.path, path_at_, state_.time_s);
    const Vec3& wished = wish.velocity_m_per_s;
    const double k = config_.hand_stiffness_n_per_m, b = config_.hand_damping_n_s_per_m;
    Vec3 behind{}, load{}, pull{};  // against the wish; all forces but spring and damping; all forces at rest
    for (std::size_t axis = 0; axis < 3; ++axis) {
        behind[axis] = state_.pose.position_m[axis] - wish.pose.position_m[axis];
        load[axis] = b * wished[axis] + state_.force_n[axis];
        pull[axis] = load[axis] - k * behind[axis];
    }
    turn(dt_s, wish);
    Vec3& v = state_.velocity_m_per_s;
    // At rest, dry friction holds against any smaller force: without this the pieces would creep.
    if (dot(v, v) == 0 && norm(pull) <= config_.coulomb_friction_n) return;

    const double mass = config_.device_mass_kg + config_.hand_mass_kg;
    double hand_power = 0, damping_power = 0;  // start and end together, for the trapezoidal rule
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double start = behind[axis], swing = dt_s * v[axis];
        const double constant = load[axis] / mass * dt_s * dt_s;
        const double ramp = k * wished[axis] / mass * dt_s * dt_s * dt_s;
        const auto end = [&](std::size_t row) {
            return motion.state[2 * row] * start + motion.state[2 * row + 1] * swing +
                   motion.constant[row] * constant + motion.ramp[row] * ramp;
        };
        const double moved = end(0) - start, v_end = end(1) / dt_s;
        const double behind_end = end(0) - wished[axis] * dt_s;
        hand_power += (b * (wished[axis] - v[axis]) - k * start) * v[axis] +
                      (b * (wished[axis] - v_end) - k * behind_end) * v_end;
        damping_power += config_.device_damping_n_s_per_m * (v[axis] * v[axis] + v_end * v_end);
        energy_.port_j += state_.force_n[axis] * moved;
        state_.pose.position_m[axis] += moved;
        v[axis] = v_end;
    }
    energy_.port_peak_j = std::max(energy_.port_peak_j, energy_.port_j);
    energy_.hand_j += hand_power / 2 * dt_s;
    energy_.damping_j += damping_power / 2 * dt_s;
    rub(dt_s);
}

void SimulatedOperator::rub(double dt_s) noexcept {
    const double mass = config_.device_mass_kg + config_.hand_mass_kg;
    Vec3& v = state_.velocity_m_per_s;
    const double before = 0.5 * mass * dot(v, v), speed = norm(v);
    const double slower = config_.coulomb_friction_n * dt_s / mass;
    for (double& component : v)
        component = speed > slower ? component * (1 - slower / speed) : slower > 0 ? 0 : component;
    energy_.kinetic_j = 0.5 * mass * dot(v, v);
    energy_.friction_j += before - energy_.kinetic_j;
}

void SimulatedOperator::turn(double dt_s, const HandWish& wish) noexcept {
    Vec3 &w = state_.angular_velocity_rad_per_s, turned{};
    QuaternionWxyz& q = state_.pose.orientation_wxyz;
    if (config_.inertia_kg_m2 > 0) {
        const Vec3 behind = rotation_vector(multiply(wish.pose.orientation_wxyz, inverse(q)));
        const double k = config_.hand_stiffness_nm_per_rad, b = config_.hand_damping_nm_s_per_rad;
        const double gain = dt_s / config_.inertia_kg_m2;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double torque = k * behind[axis] + b * wish.turn_rad_per_s[axis] + state_.torque_nm[axis];
            w[axis] = (w[axis] + gain * torque) / (1 + gain * b);
        }
    } else {
        w = wish.turn_rad_per_s;
        q = wish.pose.orientation_wxyz;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        turned[axis] = w[axis] * dt_s;
        energy_.port_j += state_.torque_nm[axis] * turned[axis];
    }
    if (dot(turned, turned) == 0) return;
    q = multiply(rotation_of(turned), q);
    double length = 0;
    for (const double component : q)
        length += component * component;
    for (double& component : q)
        component /= std::sqrt(length);
    energy_.port_peak_j = std::max(energy_.port_peak_j, energy_.port_j);
}

}  // namespace knead
