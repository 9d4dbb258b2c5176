// SPDX-License-Identifier: Apache-2.0
// Prints what contact costs: microseconds of steps apart, touching, and in which the touched nodes change.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "stability/touch.h"
#include "support/simulation_of.h"

namespace knead::test {
namespace {

constexpr double kDtS = 1e-3;
constexpr int kSteps = 1000;
constexpr int kRounds = 5;  // the least of as many runs of the same steps: what else the machine does goes

/// Down, dragged aside and around with a hand's tremor, off again, four times a second.
Pose dragged(const Pose& rest, double time_s) {
    const double phase = std::fmod(time_s, 0.25);
    const double down = ramp(phase, 0, 0.08) - ramp(phase, 0.16, 0.24);
    const Vec3 way{0.01 * std::sin(2 * M_PI * 1.3 * time_s), 0.01 * std::sin(2 * M_PI * 0.9 * time_s),
                   0.002 - 0.01 * down + 0.3e-3 * std::sin(2 * M_PI * 10 * time_s)};
    return moved(rest, way, Eigen::AngleAxisd(0, Eigen::Vector3d::UnitZ()));
}

double percentile(std::vector<double>& values, double share) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

struct Sample {
    double us = 1e9;
    std::uint32_t touched = 0, iterations = 0;
    bool changed = false;
};

void run_once(Simulation& simulation, std::vector<Sample>& samples) {
    simulation.reset();
    const Pose rest = simulation.tool_rest_pose();
    std::uint32_t before = 0;
    for (int k = 0; k < kSteps; ++k) {
        Sample& sample = samples[static_cast<std::size_t>(k)];
        const Pose pose = dragged(rest, (k + 1) * kDtS);
        const auto start = std::chrono::steady_clock::now();
        const StepResult result = simulation.step(pose, kDtS);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        sample.us = std::min(sample.us, 1e6 * took.count());
        sample.touched = result.touched_nodes;
        sample.iterations = result.solver_iterations;
        sample.changed = result.touched_nodes != before;
        before = result.touched_nodes;
    }
}

void print(const char* what, const std::vector<Sample>& samples, bool touching, bool changed) {
    std::vector<double> us, iterations;
    for (const Sample& s : samples) {
        if (s.changed != changed || (!changed && (s.touched > 0) != touching)) continue;
        us.push_back(s.us);
        iterations.push_back(s.iterations);
    }
    fmt::print(
        "    {:<10} {:5} steps: us p50 {:6.1f} p99 {:6.1f} max {:6.1f}; iterations p50 {:2.0f} max {:2.0f}\n",
        what, us.size(), percentile(us, 0.5), percentile(us, 0.99), percentile(us, 1),
        percentile(iterations, 0.5), percentile(iterations, 1));
}

void measure(std::uint32_t cells, double nu, const Touch& touch) {
    Asset asset = scenario_cube(cells, nu);
    asset.tools = {tool_above(asset, touch.shape, touch.contact)};
    Simulation simulation = simulation_of(asset);
    std::vector<Sample> samples(kSteps);
    for (int round = 0; round < kRounds; ++round)
        run_once(simulation, samples);
    std::uint32_t most = 0;
    for (const Sample& s : samples)
        most = std::max(most, s.touched);
    fmt::print("n {}, nu {}, {}, up to {} nodes\n", cells, nu, name_of(touch), most);
    print("apart", samples, false, false);
    print("touching", samples, true, false);
    print("change", samples, true, true);
}

}  // namespace
}  // namespace knead::test

int main() {
    using knead::ToolContact;
    using knead::ToolShape;
    for (const std::uint32_t cells : {6U, 8U, 10U})
        for (const double nu : {0.3, 0.49})
            for (const ToolShape shape : {ToolShape::plate, ToolShape::sphere})
                for (const ToolContact contact :
                     {ToolContact::frictionless, ToolContact::sticking, ToolContact::coulomb})
                    knead::test::measure(cells, nu, {shape, contact});
}
