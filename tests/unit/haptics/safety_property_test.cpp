// SPDX-License-Identifier: Apache-2.0
// The safety chain under anything: what it promises must hold at every sample of every input. The
// expectations are written from docs/safety.md and share nothing with the chain but its limits.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "knead/haptics/safety.h"

namespace knead::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
constexpr double kRounding = 1e-9;  ///< relative to the limits, of a few hundred sums

/// One tick, in choices that shrink towards harmless ones.
struct Event {
    int force = 0;
    int pose = 0;
    int dt = 0;
    int device = 0;
    int model = 0;
    bool failed = false;
    Vec3 direction{};  ///< components -1 to 1
};

constexpr double kForces[] = {0, 1, 2, 5, 100, 1e300, 1.7e308, kDenormal, 1e-300, -3, kNan, kInf, -kInf};
constexpr double kMoves_m[] = {0, 1e-4, 1e-3, 4e-3, 1, 1e300, kNan, kInf};
constexpr double kPeriods[] = {1,  0.5, 1.2, 4.9,   1e-9, kDenormal,
                               10, 0,   -1,  1e300, kNan, kInf};  // expected ones
constexpr double kAges_s[] = {0, 0.01, 0.018, 0.025, 0.034, 0.04, 0.048, 0.05, 1, 1e300, -1, kNan, kInf};

template <std::size_t N>
int count_of(const double (&)[N]) {
    return static_cast<int>(N);
}

/// Mostly the first few, which are harmless: else every sequence would be one long restart.
rc::Gen<int> choice(int harmless, int all) {
    return rc::gen::weightedOneOf<int>({{12, rc::gen::inRange(0, harmless)}, {1, rc::gen::inRange(0, all)}});
}

rc::Gen<double> unit() {
    return rc::gen::map(rc::gen::inRange(-1000, 1001), [](int n) { return n / 1000.0; });
}

rc::Gen<Event> events() {
    return rc::gen::build<Event>(
        rc::gen::set(&Event::force, choice(10, count_of(kForces))),
        rc::gen::set(&Event::pose, choice(4, count_of(kMoves_m))),
        rc::gen::set(&Event::dt, choice(4, count_of(kPeriods))),
        rc::gen::set(&Event::device, choice(2, count_of(kAges_s))),
        rc::gen::set(&Event::model, choice(4, count_of(kAges_s))),
        rc::gen::set(&Event::failed, rc::gen::map(rc::gen::inRange(0, 40), [](int n) { return n == 39; })),
        rc::gen::set(&Event::direction,
                     rc::gen::map(rc::gen::tuple(unit(), unit(), unit()),
                                  [](const std::tuple<double, double, double>& t) {
                                      return Vec3{std::get<0>(t), std::get<1>(t), std::get<2>(t)};
                                  })));
}

SafetyConfig config_of(int choice) {
    SafetyConfig config;
    const double scale =
        std::vector<double>{1, 1 / 3.3, 1000 / 3.3, 1e-6}[static_cast<std::size_t>(choice % 4)];
    config.max_force_n *= scale;
    config.ramp_n_per_s *= scale * (choice % 3 == 0 ? 100 : 1);  // also one that is over while a test lasts
    config.slew_n_per_ms *= choice % 5 == 0 ? 1e5 : scale;       // also one that limits nothing
    config.passivity = choice % 2 == 0;
    if (choice % 7 == 0) config.max_torque_nm = 0;
    return config;
}

SafetyInput input_of(const Event& event, double expected_dt_s, Pose& pose) {
    const auto pick = [](const auto& values, int i) { return values[static_cast<std::size_t>(i)]; };
    SafetyInput input;
    input.expected_dt_s = expected_dt_s;
    input.dt_s = pick(kPeriods, event.dt) * expected_dt_s;
    input.sample_age_s = pick(kAges_s, event.device);
    input.model_age_s = pick(kAges_s, event.model);
    input.step_failed = event.failed;
    const double move_m = pick(kMoves_m, event.pose);
    input.pose = pose;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        input.force_n[axis] = pick(kForces, event.force) * event.direction[axis];
        input.torque_nm[axis] = 0.1 * input.force_n[(axis + 1) % 3];
        input.pose.position_m[axis] += move_m * event.direction[2 - axis];
    }
    if (std::abs(move_m) < 10) pose = input.pose;
    return input;
}

long double length(const Vec3& v) {
    return std::sqrt(static_cast<long double>(v[0]) * v[0] + static_cast<long double>(v[1]) * v[1] +
                     static_cast<long double>(v[2]) * v[2]);
}

double distance(const Vec3& a, const Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

bool finite(const Vec3& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

/// What is left of a force whose data have this age when it stops being held.
double share_left(const Watchdog& watchdog, double age_s) {
    if (std::isnan(age_s) || age_s < 0) return 0;
    return std::clamp((watchdog.zero_after_s - age_s) / (watchdog.zero_after_s - watchdog.stale_after_s), 0.0,
                      1.0);
}

constexpr std::uint32_t kRestarts =
    kHapticNotFinite | kHapticBadPose | kHapticPoseJump | kHapticTimeJump | kHapticStepFailed;
constexpr std::uint32_t kStale = kHapticStaleModel | kHapticStaleDevice;

/// Limits and last value of force or torque, with a ramp kept by plain bookkeeping.
struct Port {
    double limit;
    double slew_per_s;
    double ramp_per_s;
    double ceiling = 0;
    Vec3 last{};

    void check(const Vec3& now, double share, double last_share, double step_s, std::uint32_t status) {
        const double slack = kRounding * limit;
        RC_ASSERT(finite(now));
        RC_ASSERT(length(now) <= static_cast<long double>(limit));
        RC_ASSERT(std::hypot(now[0], now[1], now[2]) <= limit);
        const bool restart = (status & kRestarts) != 0;
        if (restart || share == 0) RC_ASSERT(now == Vec3{});
        if (restart) ceiling = 0;
        if (share > last_share) ceiling = std::min(ceiling, static_cast<double>(length(last)));
        RC_ASSERT(length(now) <= ceiling + slack);
        RC_ASSERT(length(now) <= share * limit + slack);
        const double rise = static_cast<double>(length(now) - length(last));
        RC_ASSERT(rise <= (restart ? 0 : slew_per_s * step_s) + slack);
        if (!restart && share == last_share && share == 1)
            RC_ASSERT(distance(now, last) <= slew_per_s * step_s + slack);
        if (!restart) ceiling = std::min(limit, ceiling + ramp_per_s * step_s);
        last = now;
    }
};

RC_GTEST_PROP(SafetyChain, Any_sequence_and_every_promise_holds_at_every_sample, ()) {
    const SafetyConfig config = config_of(*rc::gen::inRange(0, 420));
    const double expected_dt_s = *rc::gen::element(1e-3, 1e-3, 1.0 / 500, 1.0 / 4000);
    const auto sequence = *rc::gen::scale(5, rc::gen::container<std::vector<Event>>(events()));
    SafetyChain chain = SafetyChain::create(config).value();
    Port force{config.max_force_n, config.slew_n_per_ms * 1e3, config.ramp_n_per_s};
    Port torque{config.max_torque_nm, config.slew_nm_per_ms * 1e3, config.ramp_nm_per_s};
    Pose pose;
    double last_share = 1;
    for (const Event& event : sequence) {
        const SafetyInput input = input_of(event, expected_dt_s, pose);
        const SafeForce safe = chain.apply(input);
        const double share = std::min(share_left(config.device_watchdog, input.sample_age_s + expected_dt_s),
                                      share_left(config.model_watchdog, input.model_age_s + expected_dt_s));
        const double step_s = std::min(input.dt_s, expected_dt_s);
        force.check(safe.force_n, share, last_share, step_s, safe.status);
        torque.check(safe.torque_nm, share, last_share, step_s, safe.status);
        RC_ASSERT(((safe.status & kStale) != 0) == (share < 1));
        RC_ASSERT(((safe.status & kHapticNotFinite) != 0) ==
                  !(finite(input.force_n) && finite(input.torque_nm)));
        RC_ASSERT(((safe.status & kHapticStepFailed) != 0) == input.step_failed);
        const bool good_time = input.dt_s > 0 && input.dt_s <= 5 * expected_dt_s;
        RC_ASSERT(((safe.status & kHapticTimeJump) != 0) == !good_time);
        RC_ASSERT(((safe.status & kHapticBadPose) != 0) == !finite(input.pose.position_m));
        RC_ASSERT(std::isfinite(chain.absorbed_j()));
        last_share = share;
    }
}

/// Random contact with a mild object, nothing wrong: the chain reports nothing but what it is for.
RC_GTEST_PROP(SafetyChain, Harmless_sequence_and_passes_unchanged, ()) {
    const auto angles = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 628));
    SafetyConfig config;
    config.passivity = false;
    SafetyChain chain = SafetyChain::create(config).value();
    SafetyInput input;
    input.dt_s = input.expected_dt_s;
    for (int tick = 0; tick < 400; ++tick)
        (void)chain.apply(input);
    for (const int angle : angles) {
        input.force_n = {0.49 * std::cos(angle / 100.0), 0.49 * std::sin(angle / 100.0), 3.2};
        input.pose.position_m[0] = 1e-3 * std::sin(angle / 100.0);
        const SafeForce first = chain.apply(input);
        if ((first.status & kHapticSlewLimited) != 0) continue;  // still on the way up to 3.2 N
        RC_ASSERT(first.force_n == input.force_n);
        RC_ASSERT(first.status == kHapticOk);
    }
}

}  // namespace
}  // namespace knead::test
