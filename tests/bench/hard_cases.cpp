// SPDX-License-Identifier: Apache-2.0
#include "bench/hard_cases.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "bench/loading.h"
#include "bench/scene.h"

namespace knead::bench {
namespace {

constexpr double kWayM = 0.1 * kSideM;
constexpr double kSpeedMPerS = 0.1;
constexpr double kNearlyIncompressible = 0.49;
constexpr double kForceError = 1e-3;
constexpr double kIslandForceError = 1e-2;
/// Contrast from which islands may say not_converged.
constexpr double kHardIslands = 1e6;
constexpr double kRestError = 1e-4;
/// Largest force over the largest exact one along the same motion.
constexpr double kBound = 3;
/// Timed steps per case, and the time after which no further pass is started.
constexpr std::size_t kTimedSteps = 400;
constexpr double kTimedS = 1.5;

struct Timing {
    const char* name;
    double dt_s, duration_s;
};
constexpr Timing kShortSteps{"dt 1 ms", 1e-3, 0.15};
constexpr Timing kLongSteps{"dt 10 ms", 10e-3, 0.4};

HardCase pressed(const std::string& what, std::uint32_t cells, double nu, const Timing& timing) {
    HardCase c;
    c.name = fmt::format("n {} {}, nu {}, {}", cells, what, nu, timing.name);
    c.motion = press(kWayM, kSpeedMPerS, timing.duration_s, 1.0);
    c.dt_s = timing.dt_s;
    c.compared_s = timing.duration_s;
    return c;
}

HardCase scenario(std::uint32_t cells, double nu, const Timing& timing) {
    HardCase c = pressed("scenario 1", cells, nu, timing);
    c.object = [=] { return scenario_cube(cells, nu); };
    return c;
}

HardCase contrast(std::uint32_t cells, double nu, double ratio, Layout layout, const Timing& timing) {
    const bool islands = layout == Layout::islands;
    HardCase c = pressed(fmt::format("{} 1e{:.0f}", islands ? "islands" : "percolating", std::log10(ratio)),
                         cells, nu, timing);
    c.object = [=] { return contrast_cube(cells, nu, ratio, layout); };
    c.may_be_told = islands && ratio >= kHardIslands;
    c.largest_error = c.may_be_told ? kIslandForceError : kForceError;
    return c;
}

HardCase moved(const std::string& what, std::uint32_t cells, const Motion& motion, double compared_s) {
    HardCase c;
    c.name = fmt::format("n {} {}, nu {}, {}", cells, what, kPoissonsRatio, kShortSteps.name);
    c.object = [=] { return scenario_cube(cells); };
    c.motion = motion;
    c.compared_s = compared_s;
    return c;
}

HardCase crushed(std::uint32_t cells, double rest_s) {
    HardCase c =
        moved("50 % in 0.25 s and release", cells, press_and_release(0.5 * kSideM, 0.25, 0.05, rest_s), 0.6);
    c.trajectory_defined = false;
    c.largest_rest = kRestError;
    return c;
}

HardCase fast(std::uint32_t cells) {
    return moved("30 % at 1 m/s and release", cells, press_and_release(0.3 * kSideM, 0.03, 0.05, 0.05), 0.16);
}

HardCase turned(std::uint32_t cells, double turn_s) {
    const Motion motion = press_and_twist(kWayM, kSpeedMPerS, 1.0, turn_s, 0.05);
    return moved("press and twist of 57 degrees", cells, motion, motion.duration_s);
}

double time_steps(Simulation& simulation, const HardCase& c, std::vector<double>& us) {
    simulation.reset();
    const Pose rest = simulation.tool_rest_pose();
    const auto steps = std::lround(c.compared_s / c.dt_s);
    double total_s = 0;
    for (long k = 0; k < steps; ++k) {
        const Pose pose = c.motion.pose(rest, static_cast<double>(k + 1) * c.dt_s);
        const auto start = std::chrono::steady_clock::now();
        (void)simulation.step(pose, c.dt_s);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        us.push_back(1e6 * took.count());
        total_s += took.count();
    }
    return total_s;
}

/// The part of the motion that is not compared, and how far from rest it ends, over the side.
double finish(Simulation& simulation, const Body& body, const HardCase& c) {
    const Pose rest = simulation.tool_rest_pose();
    const auto steps = std::lround(c.motion.duration_s / c.dt_s);
    for (long k = std::lround(c.compared_s / c.dt_s); k < steps; ++k)
        (void)simulation.step(c.motion.pose(rest, static_cast<double>(k + 1) * c.dt_s), c.dt_s);
    const Columns moved =
        Eigen::Map<const Columns>(simulation.positions_m(), 3, body.rest_m.cols()) - body.rest_m;
    return std::sqrt(moved.squaredNorm() / static_cast<double>(moved.cols())) / kSideM;
}

void judge(const HardCase& c, HardCaseRow& row) {
    const Accuracy& a = row.accuracy;
    row.bounded = a.largest_force_n <= kBound * a.largest_exact_force_n;
    row.finite = a.finite && a.not_finite_steps == 0 && (!row.rest || std::isfinite(*row.rest));
    if (!row.finite)
        row.verdict = "not finite";
    else if (!row.bounded)
        row.verdict = "not bounded";
    else if (row.rest && !(*row.rest <= c.largest_rest))
        row.verdict = "not recovered";
    else if (a.step_error <= c.largest_error)
        row.verdict = "ok";
    else
        row.verdict = a.step_error_when_ok <= c.largest_error ? "told" : "wrong";
    row.pass = row.verdict == "ok" || (row.verdict == "told" && c.may_be_told);
}

}  // namespace

std::vector<HardCase> hard_cases(bool quick) {
    std::vector<HardCase> cases;
    if (quick) {
        cases.push_back(scenario(3, kNearlyIncompressible, kLongSteps));
        cases.push_back(contrast(3, kPoissonsRatio, 1e3, Layout::islands, kLongSteps));
        cases.push_back(turned(3, 0.15));
        return cases;
    }
    for (const std::uint32_t cells : {6U, 8U, 10U})
        for (const Timing& timing : {kShortSteps, kLongSteps})
            cases.push_back(scenario(cells, kNearlyIncompressible, timing));
    for (const Layout layout : {Layout::percolating, Layout::islands})
        for (const double ratio : {1e3, 1e6, 1e9})
            for (const double nu : {kPoissonsRatio, kNearlyIncompressible})
                for (const Timing& timing : {kShortSteps, kLongSteps})
                    cases.push_back(contrast(6, nu, ratio, layout, timing));
    for (const std::uint32_t cells : {8U, 10U})
        for (const Layout layout : {Layout::percolating, Layout::islands})
            cases.push_back(contrast(cells, kNearlyIncompressible, 1e6, layout, kLongSteps));
    cases.push_back(crushed(6, 3.0));
    cases.push_back(crushed(8, 3.0));
    for (const std::uint32_t cells : {6U, 10U})
        cases.push_back(fast(cells));
    for (const std::uint32_t cells : {6U, 8U})
        cases.push_back(turned(cells, 0.15));
    return cases;
}

HardCaseRow measure_hard_case(const HardCase& c) {
    const Asset asset = bake_scene(press_scene(), c.object());
    const Body body = make_body(asset);
    SimulationConfig config;
    config.expected_dt_s = c.dt_s;
    config.max_linearisations = 1;  // what is compared with: one linearised step
    Simulation simulation = make_simulation(asset, config);
    HardCaseRow row;
    row.name = c.name;
    row.tetrahedra = asset.tetrahedra.size();
    row.dt_ms = 1e3 * c.dt_s;
    row.trajectory_defined = c.trajectory_defined;
    AccuracyRequest request;
    request.motion = {c.motion.pose, c.compared_s};
    request.dt_s = c.dt_s;
    row.accuracy = measure_accuracy(simulation, body, request);
    if (c.largest_rest) row.rest = finish(simulation, body, c);
    std::vector<double> us;
    for (double spent_s = 0; us.size() < kTimedSteps && spent_s < kTimedS;)
        spent_s += time_steps(simulation, c, us);
    row.us = baseline::percentiles(us);
    judge(c, row);
    return row;
}

}  // namespace knead::bench
