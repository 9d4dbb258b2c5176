// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/z_width.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/error.h"
#include "knead/runtime/simulation.h"
#include "touch/virtual_simulation.h"

namespace knead::tools {
namespace {

constexpr double kWait = 0.35;   ///< seconds at the start: the safety chain's ramp is over then
constexpr double kPress = 0.15;  ///< seconds
constexpr double kRelease = 0.15;
// Of the oscillation, from the middle third of the hold to the last.
constexpr double kGrowth = 1.2;
constexpr double kNotable = 0.5;  ///< share of the bound: growth below it is the play of the last counts
constexpr double kFading =
    0.7;  ///< a heavy device in a light grip rings for long; a limit cycle does not fade

Pose moved(Pose pose, const Vec3& direction, double way) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        pose.position_m[axis] += way * direction[axis];
    return pose;
}

/// Device frame: the origin is where the tool rests; it keeps the orientation that it rests in.
OperatorConfig pressing_hand(const ZWidthSetup& setup, const Pose& rest, double clearance_m, double force_n) {
    OperatorConfig hand = setup.hand;
    hand.period_s = 1 / setup.haptic.rate_hz;
    const Pose origin{{}, rest.orientation_wxyz};
    const Pose start = moved(origin, setup.direction, -clearance_m);
    const Pose deep = moved(origin, setup.direction, force_n / hand.hand_stiffness_n_per_m);
    const double pressed = kWait + kPress, released = pressed + setup.hold_s;
    hand.path = {{kWait, start}, {pressed, deep}, {released, deep}, {released + kRelease, start}};
    return hand;
}

/// Peak to peak, of three coordinates.
class Extent {
  public:
    void add(const Vec3& point) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            least_[axis] = std::min(least_[axis], point[axis]);
            most_[axis] = std::max(most_[axis], point[axis]);
        }
    }
    [[nodiscard]] double size() const {
        double squares = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            squares += (most_[axis] - least_[axis]) * (most_[axis] - least_[axis]);
        return std::sqrt(squares);
    }

  private:
    static constexpr double kFar = std::numeric_limits<double>::max();
    Vec3 least_{kFar, kFar, kFar}, most_{-kFar, -kFar, -kFar};
};

double norm(const Vec3& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// What is seen of a run while it goes on.
class Observer {
  public:
    Observer(const ZWidthSetup& setup, const ZWidthSearch& search) : setup_(setup), search_(search) {}

    void see(double now_s, const HapticTick& tick, const SimulatedOperator& hand) {
        const double held = (now_s - kWait - kPress) / setup_.hold_s;
        if (held >= 1.0 / 3 && held < 2.0 / 3) middle_.add(hand.state().pose.position_m);
        if (held >= 2.0 / 3 && held < 1) {
            last_.add(hand.state().pose.position_m);
            probe_.force_n += norm(tick.device_force_n);
            ++seen_;
        }
        probe_.haptic_status |= tick.status;
        probe_.step_status |= tick.step.status;
    }

    ZWidthProbe result(const SimulatedOperator& hand) {
        const double most =
            std::max(search_.oscillation_m, search_.oscillation_counts * setup_.hand.position_resolution_m);
        const double noise = setup_.hand.position_resolution_m;
        probe_.oscillation_m = last_.size();
        probe_.given_j = hand.energy().port_peak_j;
        probe_.force_n /= std::max(seen_, 1.0);
        const bool grows = last_.size() > std::max(kGrowth * middle_.size() + noise, kNotable * most);
        const bool fades = last_.size() <= kFading * middle_.size();
        probe_.stable = fades || (probe_.oscillation_m <= most && !grows);
        probe_.passive = probe_.given_j <= search_.epsilon_j;
        return probe_;
    }

  private:
    const ZWidthSetup& setup_;
    const ZWidthSearch& search_;
    ZWidthProbe probe_;
    Extent middle_, last_;
    double seen_ = 0;
};

}  // namespace

ZWidthProbe probe_stiffness(const Asset& asset, const ZWidthSetup& setup, double stiffness_n_per_m,
                            const ZWidthSearch& search) {
    HapticConfig config = setup.haptic;
    config.coupling.stiffness_n_per_m = stiffness_n_per_m;
    Simulation simulation =
        value_or_throw(Simulation::create(asset, simulation_config(config, setup.simulation)));
    config.workspace = {};
    config.workspace.offset_m = simulation.tool_rest_pose().position_m;
    config.workspace.rotation_wxyz = {1, 0, 0, 0};
    // A tool that is bonded holds the hand from the start: away from its rest, the coupling's spring would be
    // stretched by nobody, and what it gives the hand would be taken for the loop's (1 mJ at 2 kN/m and 1
    // mm).
    const bool bonded = asset.tools.at(setup.simulation.tools.front()).contact == ToolContact::bonded;
    SimulatedOperator hand = value_or_throw(SimulatedOperator::create(
        pressing_hand(setup, simulation.tool_rest_pose(), bonded ? 0 : setup.clearance_m,
                      setup.press_share * config.safety.max_force_n)));
    HapticLoop loop = value_or_throw(HapticLoop::create(hand, simulation, config));

    const bool two_rate = config.mode == HapticMode::two_rate;
    const double period_s = 1 / config.rate_hz, step_s = 1 / config.simulation_rate_hz;
    VirtualSimulation simulated(loop, step_s, setup.latency_periods * step_s);
    Observer observer(setup, search);
    const double seconds = 2 * kWait + kPress + setup.hold_s + kRelease;
    for (std::uint64_t i = 0; static_cast<double>(i) * period_s < seconds; ++i) {
        const double now_s = static_cast<double>(i) * period_s;
        if (two_rate) simulated.arrive(now_s);
        const HapticTick tick = loop.tick(period_s);
        if (two_rate) simulated.step(now_s);
        observer.see(now_s, tick, hand);
    }
    return observer.result(hand);
}

ZWidth find_z_width(const Asset& asset, const ZWidthSetup& setup, const ZWidthSearch& search) {
    ZWidth found;
    double bad_n_per_m = 0;
    const auto is_good = [&](double stiffness_n_per_m) {
        const ZWidthProbe probe = probe_stiffness(asset, setup, stiffness_n_per_m, search);
        ++found.probes;
        const bool good =
            (probe.stable || !search.must_be_stable) && (probe.passive || !search.must_be_passive);
        if (good) {
            found.stiffness_n_per_m = stiffness_n_per_m;
            found.good = probe;
        } else {
            bad_n_per_m = stiffness_n_per_m;
            found.bad = probe;
        }
        return good;
    };
    for (double stiffness = search.least_n_per_m; is_good(stiffness); stiffness *= 2)
        if (2 * stiffness > search.most_n_per_m) {
            found.at_most = true;
            return found;
        }
    if (found.stiffness_n_per_m == 0) return found;
    while (bad_n_per_m > search.ratio * found.stiffness_n_per_m)
        (void)is_good(std::sqrt(bad_n_per_m * found.stiffness_n_per_m));
    return found;
}

}  // namespace knead::tools
