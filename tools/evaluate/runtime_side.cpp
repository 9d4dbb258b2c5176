// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/runtime_side.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/error.h"
#include "evaluate/pressing.h"

namespace knead::tools {
namespace {

// The longest step of the runtime: implicit Euler damps the most there, and only the end state is asked for.
constexpr double kRestDtS = 20e-3;
constexpr int kRampSteps = 25;
constexpr int kLargestHoldSteps = 1500;
/// Still: no node moves by more than this share of the object's size in a second. Wanted is a force good to
/// 1e-4; what still moves at this rate changes it by about 1e-6.
constexpr double kStillPerSecond = 1e-6;

// Figure 8 of the paper.
constexpr double kCurveRampS = 15;
constexpr double kCurveHoldS = 5;
constexpr int kStepsBetweenPoints = 10;

double resistance_n(const Vec3& force_n, const Point& direction) {
    return -(force_n[0] * direction[0] + force_n[1] * direction[1] + force_n[2] * direction[2]);
}

double size_m(const Asset& asset) {
    double size = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] =
            std::minmax_element(asset.nodes_m.begin(), asset.nodes_m.end(),
                                [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
        size = std::max(size, (*high)[axis] - (*low)[axis]);
    }
    return size;
}

double largest_change_m(const double* positions_m, std::vector<double>& before_m) {
    double largest = 0;
    for (std::size_t k = 0; k < before_m.size(); ++k) {
        largest = std::max(largest, std::abs(positions_m[k] - before_m[k]));
        before_m[k] = positions_m[k];
    }
    return largest;
}

using Clock = std::chrono::steady_clock;

}  // namespace

RuntimeRest press_until_still(const Asset& asset, std::size_t tool, const Point& direction, double way_m) {
    Simulation simulation = simulation_of(asset, tool, kRestDtS);
    const Pose rest = simulation.tool_rest_pose(0);
    const double still_m = kStillPerSecond * size_m(asset) * kRestDtS;
    RuntimeRest result;
    std::vector<double> before_m(3 * simulation.node_count());
    for (int k = 1; k <= kRampSteps + kLargestHoldSteps && !result.is_still; ++k) {
        const double share = std::min(1.0, static_cast<double>(k) / kRampSteps);
        const StepResult step = simulation.step(moved(rest, direction, share * way_m), kRestDtS);
        result.force_n = resistance_n(step.force_n, direction);
        result.status |= step.status;
        const double change_m = largest_change_m(simulation.positions_m(), before_m);
        result.is_still = k > kRampSteps && change_m < still_m;
    }
    return result;
}

ForceCurve press_curve(const Asset& asset, std::size_t tool, const Point& direction, double way_m) {
    Simulation simulation = simulation_of(asset, tool, kRestDtS);
    const Pose rest = simulation.tool_rest_pose(0);
    ForceCurve curve;
    const int steps = static_cast<int>(std::lround((kCurveRampS + kCurveHoldS) / kRestDtS));
    for (int k = 1; k <= steps; ++k) {
        const double time_s = k * kRestDtS;
        const double share = std::min(1.0, time_s / kCurveRampS);
        const StepResult step = simulation.step(moved(rest, direction, share * way_m), kRestDtS);
        if (k % kStepsBetweenPoints != 0) continue;
        curve.time_s.push_back(time_s);
        curve.force_n.push_back(resistance_n(step.force_n, direction));
    }
    return curve;
}

double time_load_ms(const std::filesystem::path& asset_file, int repetitions) {
    std::vector<double> ms;
    for (int k = 0; k < repetitions; ++k) {
        const auto from = Clock::now();
        const Result<Simulation> loaded = Simulation::load(asset_file);
        ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - from).count());
        if (!loaded.ok()) fail_result("the runtime refuses the asset: " + loaded.error().text());
    }
    std::nth_element(ms.begin(), ms.begin() + repetitions / 2, ms.end());
    return ms[static_cast<std::size_t>(repetitions / 2)];
}

}  // namespace knead::tools
