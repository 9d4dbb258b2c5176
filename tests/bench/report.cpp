// SPDX-License-Identifier: Apache-2.0
#include "bench/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace knead::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kKibibyte = 1024;

Json json(const Machine& m, double flops_per_s) {
    return {{"cpu", m.cpu}, {"isa", m.isa},   {"compiler", m.compiler},          {"flags", m.flags},
            {"os", m.os},   {"core", m.core}, {"peak_gflops", flops_per_s / 1e9}};
}

Json json(const SpeedRow& r) {
    return {{"tets", r.tetrahedra},
            {"us_min", r.us.min},
            {"us_p50", r.us.p50},
            {"us_p99", r.us.p99},
            {"us_p999", r.us.p999},
            {"baseline_us_p50", r.baseline_us.p50},
            {"ratio", r.ratio},
            {"pcg_iterations", r.mean_iterations},
            {"force_error", r.force_error},
            {"trajectory_error", r.trajectory_error},
            {"bound_us", r.bound.us},
            {"load_ms", r.loading.median_ms},
            {"allocations", r.allocations},
            // Beyond what schema 1 promises:
            {"cells", r.cells},
            {"nodes", r.nodes},
            {"timed_steps", r.timed_steps},
            {"cold_starts", r.cold_starts},
            {"pcg_iterations_max", r.largest_iterations},
            {"not_ok_steps", r.bad_status_steps},
            {"repeatable", r.repeatable},
            {"baseline_us_min", r.baseline_us.min},
            {"baseline_pcg_iterations", r.baseline_mean_iterations},
            {"baseline_force_error", r.baseline_force_error},
            {"baseline_timed_steps", r.baseline_timed_steps},
            {"bound_ratio", r.us.p50 / r.bound.us},
            {"bound_method", r.bound.method},
            {"bytes_per_step", r.bound.work.bytes},
            {"flops_per_step", r.bound.work.flops},
            {"bandwidth_gb_per_s", r.bound.bytes_per_s / 1e9},
            {"load_first_ms", r.loading.first_ms},
            {"preconditioner_bytes", r.preconditioner_bytes},
            {"asset_bytes", r.loading.file_bytes},
            {"simulation_bytes", r.loading.simulation_bytes}};
}

Json json(const HardCaseRow& r) {
    const Accuracy& a = r.accuracy;
    Json j = {{"name", r.name},
              {"tets", r.tetrahedra},
              {"dt_ms", r.dt_ms},
              {"verdict", r.verdict},
              {"pass", r.pass},
              {"force_error", a.step_error},
              {"force_error_when_ok", a.step_error_when_ok},
              {"steps", a.steps},
              {"not_converged_steps", a.not_converged_steps},
              {"not_finite_steps", a.not_finite_steps},
              {"other_status_steps", a.other_status_steps},
              {"finite", r.finite},
              {"bounded", r.bounded},
              {"largest_force_n", a.largest_force_n},
              {"largest_exact_force_n", a.largest_exact_force_n},
              {"pcg_iterations", a.mean_iterations},
              {"pcg_iterations_max", a.largest_iterations},
              {"us_p50", r.us.p50},
              {"us_p99", r.us.p99}};
    if (r.trajectory_defined) j["trajectory_error"] = a.trajectory_error;
    if (r.rest) j["rest_rms_over_side"] = *r.rest;
    return j;
}

Json json(const LeaveOutRow& r) {
    return {{"scene", r.scene},
            {"asset_bytes", r.file_bytes},
            {"simulation_bytes", r.simulation_bytes},
            {"us_min", r.us.min},
            {"us_p50", r.us.p50}};
}

Json json(const HapticCycleRow& r) {
    return {{"rendering", r.rendering}, {"ticks", r.ticks},   {"us_min", r.us.min},
            {"us_p50", r.us.p50},       {"us_p99", r.us.p99}, {"us_p999", r.us.p999}};
}

template <class Row>
Json json_rows(const std::vector<Row>& rows) {
    Json array = Json::array();
    for (const Row& row : rows)
        array.push_back(json(row));
    return array;
}

}  // namespace

std::string to_json(const Report& report) {
    const Json document = {{"schema", "knead-bench/1"},
                           {"machine", json(report.machine, report.flops_per_s)},
                           {"command", report.command},
                           {"steps", json_rows(report.steps)},
                           {"hard_cases", json_rows(report.hard_cases)},
                           {"leave_out", json_rows(report.leave_out)},
                           {"haptic_cycle", json_rows(report.haptic_cycle)}};
    return document.dump(2) + "\n";
}

std::string machine_text(const Machine& m, double flops_per_s) {
    const std::string core = m.core < 0 ? "not pinned" : fmt::format("core {}", m.core);
    return fmt::format("{}, {}, {}; peak {:.0f} GFlop/s ({})\n{}; {}\n", m.cpu, core, m.os, flops_per_s / 1e9,
                       m.isa, m.compiler, m.flags);
}

std::string speed_heading() {
    return fmt::format("{:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>6} {:>9} {:>10} {:>10} {:>6} {:>4}\n", "tets",
                       "us min", "p50", "p99", "p99.9", "baseline", "ratio", "PCG (max)", "force err",
                       "traj. err", "not ok", "same");
}

std::string speed_line(const SpeedRow& r) {
    return fmt::format(
        "{:>7} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>6.1f} {:>9} {:>10.1e} {:>10.1e} {:>6} {:>4}\n",
        r.tetrahedra, r.us.min, r.us.p50, r.us.p99, r.us.p999, r.baseline_us.p50, r.ratio,
        fmt::format("{:.1f} ({})", r.mean_iterations, r.largest_iterations), r.force_error,
        r.trajectory_error, r.bad_status_steps, r.repeatable ? "yes" : "NO");
}

std::string cost_heading() {
    return fmt::format("{:>7} {:>9} {:>9} {:>9} {:>8} {:>9}  {:<13} {:>8} {:>8} {:>9} {:>9} {:>7}\n", "tets",
                       "kB/step", "kflop", "GB/s", "bound us", "p50/bound", "bound by", "load ms", "(first)",
                       "asset kB", "memory kB", "allocs");
}

std::string cost_line(const SpeedRow& r) {
    return fmt::format(
        "{:>7} {:>9.0f} {:>9.0f} {:>9.0f} {:>8.1f} {:>9.1f}  {:<13} {:>8.2f} {:>8.2f} {:>9.0f} {:>9.0f} "
        "{:>7}\n",
        r.tetrahedra, r.bound.work.bytes / kKibibyte, r.bound.work.flops / 1e3, r.bound.bytes_per_s / 1e9,
        r.bound.us, r.us.p50 / r.bound.us, r.bound.method, r.loading.median_ms, r.loading.first_ms,
        static_cast<double>(r.loading.file_bytes) / kKibibyte,
        static_cast<double>(r.loading.simulation_bytes) / kKibibyte, r.allocations);
}

std::string hard_case_heading() {
    return fmt::format("{:<46} {:>9} {:>9} {:>9} {:>7} {:>11} {:>9} {:>9}  {}\n", "hard case", "force err",
                       "if ok", "traj. err", "not cv.", "PCG (max)", "us p50", "p99", "verdict");
}

std::string hard_case_line(const HardCaseRow& r) {
    const Accuracy& a = r.accuracy;
    const std::string rest = r.rest ? fmt::format(", rest {:.1e}", *r.rest) : "";
    return fmt::format("{:<46} {:>9.1e} {:>9.1e} {:>9} {:>7} {:>11} {:>9.1f} {:>9.1f}  {}{}{}\n", r.name,
                       a.step_error, a.step_error_when_ok,
                       r.trajectory_defined ? fmt::format("{:.1e}", a.trajectory_error) : "-",
                       fmt::format("{}/{}", a.not_converged_steps, a.steps),
                       fmt::format("{:.1f} ({})", a.mean_iterations, a.largest_iterations), r.us.p50,
                       r.us.p99, r.pass ? "" : "FAIL: ", r.verdict, rest);
}

std::string leave_out_heading() {
    return fmt::format("{:<24} {:>11} {:>12} {:>8} {:>8}\n", "scene", "asset bytes", "memory kB", "us min",
                       "us p50");
}

std::string leave_out_line(const LeaveOutRow& r) {
    return fmt::format("{:<24} {:>11} {:>12} {:>8.1f} {:>8.1f}\n", r.scene, r.file_bytes,
                       r.simulation_bytes / static_cast<std::int64_t>(kKibibyte), r.us.min, r.us.p50);
}

std::string haptic_cycle_heading() {
    return fmt::format("{:<24} {:>8} {:>8} {:>8} {:>8}\n", "rendering", "us min", "us p50", "us p99",
                       "us p99.9");
}

std::string haptic_cycle_line(const HapticCycleRow& r) {
    return fmt::format("{:<24} {:>8.2f} {:>8.2f} {:>8.2f} {:>8.2f}\n", r.rendering, r.us.min, r.us.p50,
                       r.us.p99, r.us.p999);
}

}  // namespace knead::bench
