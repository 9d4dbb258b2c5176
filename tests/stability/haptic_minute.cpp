// SPDX-License-Identifier: Apache-2.0
// A minute of touch in real time, by a simulated hand: synchronous, and two-rate with the simulation at 60,
// 120 and 500 Hz. Prints what the clock and the energy said; exits with 1 if a force was not finite or passed
// its limit. What was given to the hand after the machine had held us up, until it next left the object,
// stands in a column of its own: a jump of time in contact is not the object's doing.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "knead/haptics/haptic_loop.h"
#include "knead/haptics/simulated_operator.h"
#include "unit/runtime/block_asset.h"

namespace knead::test {
namespace {

constexpr double kEpsilonJ =
    5e-4;  ///< a surface that is found up to a millisecond late, at 0.1 m/s and 10 kN/m
constexpr double kDepthM = 0.008;      ///< what the hand asks for
constexpr double kClearanceM = 0.004;  ///< where it waits: above the surface, unless the tool is bonded to it
constexpr double kCycleS = 2;          ///< in, hold, out, wait
constexpr double kUnloadedN = 0.033;   ///< a hundredth of the full force: the hand is out of contact
constexpr double kLostPeriod = 1.5;    ///< periods: a tick this long comes after one that was missed

struct Case {
    const char* name;
    HapticMode mode;
    double simulation_rate_hz;
};
constexpr Case kCases[] = {{"synchronous", HapticMode::synchronous, 1000},
                           {"two-rate 60 Hz", HapticMode::two_rate, 60},
                           {"two-rate 120 Hz", HapticMode::two_rate, 120},
                           {"two-rate 500 Hz", HapticMode::two_rate, 500}};

OperatorConfig pressing_hand(double seconds, double clearance_m) {
    OperatorConfig hand;
    hand.position_resolution_m = 2e-5;
    Pose start, deep;
    start.position_m[2] = clearance_m;
    deep.position_m[2] = -kDepthM;
    for (double t = 0; t < seconds; t += kCycleS) {
        hand.path.push_back({t + 0.2 * kCycleS, start});
        hand.path.push_back({t + 0.3 * kCycleS, deep});
        hand.path.push_back({t + 0.8 * kCycleS, deep});
        hand.path.push_back({t + 0.9 * kCycleS, start});
    }
    return hand;
}

/// What is seen of the force.
struct Seen {
    double most_n = 0, largest_change_n = 0;
    Vec3 last{};
    bool finite = true;

    void add(const Vec3& f) {
        const auto norm = [](double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); };
        most_n = std::max(most_n, norm(f[0], f[1], f[2]));
        largest_change_n = std::max(largest_change_n, norm(f[0] - last[0], f[1] - last[1], f[2] - last[2]));
        finite = finite && std::isfinite(f[0] + f[1] + f[2]);
        last = f;
    }
};

/// The energy that the hand was given beyond what it had paid in since it was last out of contact, or in all
/// contacts before: ours, and what came after the machine had held us up in a contact, until that was left.
class Given {
  public:
    /// @param held_up the machine took periods from us just before this tick
    void add(const HapticTick& tick, double port_j, bool held_up) {
        stalls_ += held_up ? 1 : 0;
        jumps_ += held_up && (tick.status & kHapticTimeJump) != 0 ? 1 : 0;
        machine_ = machine_ || held_up;
        const Vec3& f = tick.scene_force_n;
        const bool free = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) < kUnloadedN;
        double& most_j = machine_ ? machine_j_ : ours_j_;
        most_j = std::max(most_j, port_j - paid_j_);
        if (free) paid_j_ = machine_ ? port_j : std::min(paid_j_, port_j);
        if (free) machine_ = false;
    }
    [[nodiscard]] double ours_j() const { return ours_j_; }
    [[nodiscard]] double machine_j() const { return machine_j_; }
    [[nodiscard]] int stalls() const { return stalls_; }
    [[nodiscard]] int jumps() const { return jumps_; }

  private:
    double paid_j_ = 0;  ///< the least that the hand had out of contact
    double ours_j_ = 0, machine_j_ = 0;
    int stalls_ = 0, jumps_ = 0;
    bool machine_ = false;
};

bool run(const Result<Simulation>& probe, const std::string& asset, std::uint32_t cells, const Case& which,
         double seconds) {
    HapticConfig config;
    config.mode = which.mode;
    config.simulation_rate_hz = which.simulation_rate_hz;
    config.workspace.offset_m = probe.value().tool_rest_pose().position_m;
    config.workspace.rotation_wxyz = {1, 0, 0, 0};
    config.coupling.damping_n_s_per_m = 1;
    auto simulation = asset.empty()
                          ? Simulation::create(cube_asset(cells, ToolShape::plate, ToolContact::sticking),
                                               simulation_config(config))
                          : Simulation::load(asset, simulation_config(config));
    if (!simulation) return false;
    // A hand that engages with a bonded tool out of its place is given what the object then holds.
    const bool bonded = simulation.value().step(simulation.value().tool_rest_pose(), 1e-3).touched_nodes > 0;
    simulation.value().reset();
    auto hand = SimulatedOperator::create(pressing_hand(seconds, bonded ? 0 : kClearanceM));
    if (!hand) return false;
    auto loop = HapticLoop::create(hand.value(), simulation.value(), config);
    if (!loop) return false;
    Seen seen;
    Given given;
    std::uint64_t preempted = 0;
    const auto done = loop.value().run(seconds, [&](const HapticTick& tick) {
        seen.add(tick.device_force_n);
        const bool lost = tick.dt_s * config.rate_hz > kLostPeriod;
        const std::uint64_t now = lost ? loop.value().statistics().misses_preempted : preempted;
        given.add(tick, hand.value().energy().port_j, now > preempted);
        preempted = now;
    });
    if (!done) return false;
    const RunStatistics& s = done.value();
    const double us = 1e6;
    std::printf(
        "%-16s %8llu %7llu %7llu %7.1f %7.2f %7.2f %8.2f %8.1f %8.1f %8.1f %8.1f %8.4f %8.3f %9.1e %9.1e %6d "
        "%5d %s\n",
        which.name, static_cast<unsigned long long>(s.ticks), static_cast<unsigned long long>(s.misses_ours),
        static_cast<unsigned long long>(s.misses_preempted), us * s.jitter_s, us * s.haptic.p50_s,
        us * s.haptic.p99_s, us * s.haptic.max_s, us * s.tick.p50_s, us * s.tick.p99_s, us * s.tick.max_s,
        us * s.simulation.p50_s, seen.largest_change_n, seen.most_n, given.ours_j(), given.machine_j(),
        given.stalls(), given.jumps(), given.ours_j() <= kEpsilonJ ? "passive" : "ACTIVE");
    std::printf("%-16s real-time priority %s; simulation late %llu times; status %#x, steps %#x\n", "",
                s.realtime_priority ? "yes" : ("no (errno " + std::to_string(s.realtime_error) + ")").c_str(),
                static_cast<unsigned long long>(s.simulation_misses), s.haptic_status, s.step_status);
    std::fflush(stdout);
    return seen.finite && seen.most_n <= config.safety.max_force_n * (1 + 1e-12);
}

}  // namespace
}  // namespace knead::test

int main(int argc, char** argv) {
    using namespace knead;
    using namespace knead::test;
    const bool cube = argc > 2 && std::string(argv[1]) == "--cube";
    if (argc < 2 || (cube && argc < 3)) {
        std::fprintf(stderr,
                     "Usage: haptic_minute ASSET [SECONDS]\n       haptic_minute --cube CELLS [SECONDS]\n");
        return 2;
    }
    const std::string asset = cube ? "" : argv[1];
    const auto cells = static_cast<std::uint32_t>(cube ? std::max(2, std::atoi(argv[2])) : 2);
    const int at = cube ? 3 : 2;
    const double seconds = argc > at ? std::atof(argv[at]) : 60;
    const auto probe = cube ? Simulation::create(cube_asset(cells, ToolShape::plate, ToolContact::sticking))
                            : Simulation::load(asset);
    if (!probe) {
        std::fprintf(stderr, "haptic_minute: error: %s\n", probe.error().text().c_str());
        return 3;
    }
    std::printf("%zu tetrahedra, 1 kHz, %g s each; times in us; passive: at most %.1e J given to the hand\n",
                probe.value().tetrahedron_count(), seconds, kEpsilonJ);
    std::printf("%-16s %8s %7s %7s %7s %7s %7s %8s %8s %8s %8s %8s %8s %8s %9s %9s %6s %5s\n", "", "ticks",
                "missed", "preempt", "jitter", "hap p50", "p99", "max", "tick p50", "p99", "max", "step p50",
                "N/tick", "max N", "given J", "machine J", "stalls", "jumps");
    bool good = true;
    for (const Case& which : kCases)
        good = run(probe, asset, cells, which, seconds) && good;
    return good ? 0 : 1;
}
