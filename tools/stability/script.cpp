// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability/script.h"

#include <algorithm>
#include <cmath>

namespace knead::tools::stability {
namespace {

constexpr double kFewestRampSteps = 20;
constexpr double kRadian_s = 0.5;
constexpr double kShortHold = 0.1;  // of the ramp
/// Where waves pass within a step, implicit Euler itself needs some steps to come to rest.
constexpr double kFewestRestSteps = 50;

/// A radian of turn counts for half a second.
double ramp_s_of(const Press& press, double dt_s) {
    if (press.ramp_s > 0) return press.ramp_s;
    const double way_m = std::hypot(press.way_m[0], press.way_m[1], press.way_m[2]);
    return std::max(
        {way_m / kHandSpeed_m_per_s, kRadian_s * std::abs(press.turn.angle()), kFewestRampSteps * dt_s});
}

}  // namespace

Pose moved(const Pose& rest, const Point& way_m, const Eigen::AngleAxisd& turn) {
    Pose pose = rest;
    for (std::size_t k = 0; k < 3; ++k)
        pose.position_m[k] += way_m[k];
    const auto& q = rest.orientation_wxyz;
    const Eigen::Quaterniond turned = Eigen::Quaterniond(turn) * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    pose.orientation_wxyz = {turned.w(), turned.x(), turned.y(), turned.z()};
    return pose;
}

Script press_script(const Specimen& specimen, const Press& press, double dt_s) {
    const double ramp_s = ramp_s_of(press, dt_s);
    const double settle_s = std::max(specimen.settle_s(), kFewestRestSteps * dt_s);
    Script script;
    script.dt_s = dt_s;
    script.still_s = ramp_s;
    script.leave_s =
        ramp_s + press.longer_s + (press.holds ? settle_s : std::max(kShortHold * ramp_s, 5 * dt_s));
    script.released_s = script.leave_s + ramp_s;
    script.end_s = script.released_s + press.longer_s +
                   (press.rests ? settle_s : std::max(kShortHold * ramp_s, 5 * dt_s));
    const double leave_s = script.leave_s, released_s = script.released_s, size_m = specimen.size_m;
    script.move = [=](double time_s, std::vector<Pose>& poses) {
        const double share = std::clamp(std::min(time_s / ramp_s, (released_s - time_s) / ramp_s), 0.0, 1.0);
        // Away beyond the start of the press, at the same speed.
        const double beyond = press.leaves ? std::clamp((time_s - released_s) / ramp_s, 0.0, 1.0) : 0;
        const Point way{share * press.way_m[0], share * press.way_m[1],
                        share * press.way_m[2] + beyond * size_m};
        const double angle =
            time_s < leave_s || !press.leaves ? share * press.turn.angle() : press.turn.angle();
        for (Pose& pose : poses)
            pose = moved(pose, way, Eigen::AngleAxisd(angle, press.turn.axis()));
    };
    return script;
}

}  // namespace knead::tools::stability
