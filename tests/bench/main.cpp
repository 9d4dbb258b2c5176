// SPDX-License-Identifier: Apache-2.0
// knead-bench: how fast and how right the runtime is, in one run (docs/benchmark.md).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "bench/core_speed.h"
#include "bench/report.h"
#include "knead/formats/write/write.h"

namespace knead::bench {
namespace {

/// What the command line asks for.
struct Options {
    std::vector<std::uint32_t> sizes{6, 8, 10, 20};
    int steps = 6000;
    bool quick = false;
    std::string hard_cases = "with";
    std::string filter;
    std::string json;
    std::optional<int> core;
};

constexpr std::uint32_t kQuickSizes[] = {3, 4};
constexpr int kQuickSteps = 200;
constexpr std::uint32_t kLargestSize = 40;
/// Objects above this many cells per side are compared with exact steps over one short motion only.
constexpr std::uint32_t kLargestCompared = 12;
constexpr std::uint32_t kLeaveOutCells = 6;
constexpr int kLeaveOutSteps = 2000;
constexpr int kHapticTicks = 20'000;

void say(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

SpeedRequest speed_request(const Options& options, std::uint32_t cells, double flops_per_s) {
    SpeedRequest request;
    request.cells = cells;
    request.steps = options.steps;
    request.flops_per_s = flops_per_s;
    if (options.quick) request.accuracy_s = 0.03;
    if (cells > kLargestCompared) request.accuracy_s = 0.12;
    if (options.quick || cells > kLargestCompared) request.accuracy_motions = 1;
    return request;
}

void run_speed(const Options& options, Report& report) {
    say("\nOne step of 1 ms: scenario 1, press of 10 % with tremor, cold starts\n" + speed_heading());
    for (const std::uint32_t cells : options.sizes) {
        report.steps.push_back(measure_speed(speed_request(options, cells, report.flops_per_s)));
        say(speed_line(report.steps.back()));
    }
    say("\nWhat a step costs at least, loading and memory\n" + cost_heading());
    for (const SpeedRow& row : report.steps)
        say(cost_line(row));
    say("\nWhat a scene that leaves things out saves\n" + leave_out_heading());
    report.leave_out = measure_leave_out(options.quick ? kQuickSizes[0] : kLeaveOutCells,
                                         options.quick ? kQuickSteps : kLeaveOutSteps);
    for (const LeaveOutRow& row : report.leave_out)
        say(leave_out_line(row));
    say("\nThe haptic part of a cycle, two-rate, without the simulation's step\n" + haptic_cycle_heading());
    report.haptic_cycle = measure_haptic_cycle(kQuickSizes[0], options.quick ? kQuickSteps : kHapticTicks);
    for (const HapticCycleRow& row : report.haptic_cycle)
        say(haptic_cycle_line(row));
}

void run_hard_cases(const Options& options, Report& report) {
    say("\nHard cases\n" + hard_case_heading());
    for (const HardCase& hard_case : hard_cases(options.quick)) {
        if (hard_case.name.find(options.filter) == std::string::npos) continue;
        report.hard_cases.push_back(measure_hard_case(hard_case));
        say(hard_case_line(report.hard_cases.back()));
    }
}

void run(const Options& options, const std::string& command) {
    Report report;
    report.command = command;
    report.machine = describe_machine(options.core);
    report.flops_per_s = measure_peak_flops();
    say(machine_text(report.machine, report.flops_per_s));
    if (options.hard_cases != "only") run_speed(options, report);
    if (options.hard_cases != "none") run_hard_cases(options, report);
    if (options.json.empty()) return;
    if (const Status written = write_text_file(options.json, to_json(report)); !written)
        throw std::runtime_error(written.error().text());
}

void declare(CLI::App& app, Options& options) {
    app.add_option("--sizes", options.sizes, "cells per side of the cubes, 6 tetrahedra in each")
        ->delimiter(',')
        ->check(CLI::Range(2U, kLargestSize))
        ->capture_default_str();
    app.add_option("--steps", options.steps, "timed steps of each size; fewer when they take more than 20 s")
        ->check(CLI::Range(100, 10'000'000))
        ->capture_default_str();
    app.add_flag("--quick", options.quick, "tiny objects and few steps: checks the program, not the speed");
    app.add_option("--hard-cases", options.hard_cases, "with, only, none")
        ->check(CLI::IsMember({"with", "only", "none"}))
        ->capture_default_str();
    app.add_option("--filter", options.filter, "only hard cases whose name contains this text");
    app.add_option("--core", options.core, "run on this core only");
    app.add_option("--json", options.json, "also write everything as JSON to this file");
}

}  // namespace
}  // namespace knead::bench

int main(int argc, char** argv) {
    CLI::App app("knead-bench: speed and force errors of the runtime, beside a plain baseline and a bound.");
    knead::bench::Options options;
    knead::bench::declare(app, options);
    CLI11_PARSE(app, argc, argv);
    if (options.quick) {
        if (app.count("--sizes") == 0)
            options.sizes.assign(std::begin(knead::bench::kQuickSizes), std::end(knead::bench::kQuickSizes));
        if (app.count("--steps") == 0) options.steps = knead::bench::kQuickSteps;
    }
    std::string command = "knead-bench";
    for (int k = 1; k < argc; ++k)
        command += std::string(" ") + argv[k];
    try {
        knead::bench::run(options, command);
    } catch (const std::exception& e) {
        fmt::print(stderr, "knead-bench: error: {}\n", e.what());
        return 1;
    }
    return 0;
}
