// SPDX-License-Identifier: Apache-2.0
#include "knead/haptics/passivity.h"

#include <algorithm>

#include "knead/haptics/safety/norm_limit.h"
#include "knead/haptics/status.h"

namespace knead {
namespace {

/// Of the full force: a damper below it is nothing to tell.
constexpr double kNoticeable = 1e-3;
/// Of the full force: an object that wants less has given back what it held. In the air a moved proxy's
/// inertia leaves a few millinewtons.
constexpr double kUnloaded = 1e-2;

double dot(const Vec3& a, const Vec3& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

void PassivityController::observe(const Vec3& held, const Vec3& moved, double dt_s) noexcept {
    const double taken_j = -dot(held, moved);
    absorbed_j_ += taken_j;
    energy_j_ = std::max(energy_j_ + taken_j, -limits_.max_debt_j);
    newest_ = (newest_ + 1) % kWindow;
    window_[newest_] = {moved, dt_s};
    filled_ = std::min(filled_ + 1, kWindow);
}

Vec3 PassivityController::velocity(double hold_s) const noexcept {
    Vec3 moved{};
    double time_s = 0;
    // Two samples at once are no reason to believe in infinite speed.
    const double shortest_s = hold_s / 2;
    for (std::size_t i = 0; i < filled_; ++i) {
        const Sample& sample = window_[(newest_ + kWindow - i) % kWindow];
        for (std::size_t axis = 0; axis < 3; ++axis)
            moved[axis] += sample.moved[axis];
        time_s += sample.dt_s;
        const bool seen = dot(moved, moved) >= limits_.resolution * limits_.resolution;
        if (seen && time_s >= shortest_s) break;
    }
    const double divisor = std::max(time_s, shortest_s);
    return {moved[0] / divisor, moved[1] / divisor, moved[2] / divisor};
}

Vec3 PassivityController::damp(const Vec3& force, double wish, double hold_s,
                               std::uint32_t& status) noexcept {
    const double stock_j = std::min(wish * (wish / (2 * limits_.softest)), full_force_ * limits_.travel);
    energy_j_ = std::min(energy_j_, stock_j);
    if (!(wish > 0)) return force;
    const Vec3 v = velocity(hold_s);
    const double next_j = energy_j_ - dot(force, v) * hold_s;
    const double missing_j = -limits_.free_energy_j - next_j;
    const double damping = std::min(missing_j / (dot(v, v) * hold_s), limits_.max_damping);
    if (!(damping > 0)) return force;
    if (damping * norm(v) > kNoticeable * full_force_) status |= kHapticPassivity;
    return {force[0] - damping * v[0], force[1] - damping * v[1], force[2] - damping * v[2]};
}

double PassivityController::share(double wish) noexcept {
    if (wish <= kUnloaded * full_force_) recovering_ = false;
    if (!recovering_ || !(limits_.max_damping > 0)) return 1;
    if (energy_j_ >= 0) return 1;
    return std::max(kLeast, 1 + energy_j_ / (2 * limits_.free_energy_j));  // none free: minus infinity
}

void PassivityController::reset() noexcept {
    energy_j_ = 0;
    filled_ = 0;
    recovering_ = true;
}

}  // namespace knead
