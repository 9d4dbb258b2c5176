// SPDX-License-Identifier: GPL-3.0-or-later
#include "touch/press_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.h"
#include "knead/runtime/simulation.h"

namespace knead::tools {
namespace {

constexpr double kStair_m = 0.25e-3;
constexpr double kLeastStairs = 8;              ///< of a small object
constexpr double kStep_s = 20e-3;               ///< the longest: implicit Euler damps most then
constexpr int kMoveSteps = 5, kRestSteps = 10;  ///< of each stair

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double extent_m(const Asset& asset, const Vec3& direction) {
    double least = std::numeric_limits<double>::max(), most = -least;
    for (const Point& node : asset.nodes_m) {
        least = std::min(least, dot(node, direction));
        most = std::max(most, dot(node, direction));
    }
    return most - least;
}

double along(const Mat6& matrix, const Vec3& direction) {
    double sum = 0;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            sum += direction[row] * matrix[6 * row + column] * direction[column];
    return sum;
}

/// One tool on its way, in virtual time.
class StairPress {
  public:
    StairPress(const Asset& asset, std::size_t tool, const PressLine& line)
        : line_(line), simulation_(value_or_throw(Simulation::create(asset, config(tool)))) {}

    PressPoint go_to(double depth_m) {
        const double from_m = at_m_;
        for (int i = 1; i <= kMoveSteps; ++i)
            step(from_m + (depth_m - from_m) * i / kMoveSteps);
        for (int i = 0; i < kRestSteps; ++i)
            step(depth_m);
        LocalModel model;
        if (!simulation_.local_model(0, model)) fail_result("the simulation gives no local model");
        return {depth_m, std::sqrt(dot(model.force_n, model.force_n)),
                along(model.stiffness, line_.direction), model.touched_nodes};
    }

  private:
    static SimulationConfig config(std::size_t tool) {
        SimulationConfig config;
        config.tools = {tool};
        config.expected_dt_s = kStep_s;
        config.with_local_model = true;
        return config;
    }
    void step(double depth_m) {
        Pose pose = line_.rest;
        for (std::size_t axis = 0; axis < 3; ++axis)
            pose.position_m[axis] += depth_m * line_.direction[axis];
        const StepResult result = simulation_.step(pose, kStep_s);
        if ((result.status & (kStepNotFinite | kStepBadInput)) != 0)
            fail_result(fmt::format("the simulation fails at a depth of {:g} mm", 1e3 * depth_m));
        at_m_ = depth_m;
    }

    PressLine line_;
    Simulation simulation_;
    double at_m_ = 0;
};

}  // namespace

std::optional<PressPoint> PressCurve::at(double depth_m) const {
    constexpr double kRounding = 1e-9;  // of a stair: sums of stairs
    if (depth_m > deepest_m() + kRounding * stair_m) return std::nullopt;
    std::size_t after = 1;
    while (after + 1 < points.size() && points[after].depth_m < depth_m)
        ++after;
    const PressPoint &a = points[after - 1], &b = points[after];
    const double share = std::clamp((depth_m - a.depth_m) / (b.depth_m - a.depth_m), 0.0, 1.0);
    return PressPoint{depth_m, std::lerp(a.force_n, b.force_n, share),
                      std::lerp(a.stiffness_n_per_m, b.stiffness_n_per_m, share),
                      share < 0.5 ? a.touched_nodes : b.touched_nodes};
}

std::optional<double> PressCurve::depth_of_force(double force_n) const {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].force_n < force_n) continue;
        if (i == 0) return points[0].depth_m;
        const PressPoint &a = points[i - 1], &b = points[i];
        return std::lerp(a.depth_m, b.depth_m, (force_n - a.force_n) / (b.force_n - a.force_n));
    }
    return std::nullopt;
}

std::optional<PressPoint> PressCurve::contact() const {
    for (const PressPoint& point : points)
        if (point.touched_nodes > 0) return point;
    return std::nullopt;
}

PressCurve press_curve(const Asset& asset, std::size_t tool, const PressLine& line) {
    const double deepest_m = std::min(kDeepestPress_m, kDeepestShare * extent_m(asset, line.direction));
    PressCurve curve;
    curve.stair_m = std::min(kStair_m, deepest_m / kLeastStairs);
    const auto stairs = static_cast<int>(deepest_m / curve.stair_m * (1 + 1e-9));
    StairPress press(asset, tool, line);
    for (int i = 0; i <= stairs; ++i)
        curve.points.push_back(press.go_to(i * curve.stair_m));
    return curve;
}

}  // namespace knead::tools
