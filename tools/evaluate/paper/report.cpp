// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/paper/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace knead::tools {
namespace {

std::string percent(double share) {
    return fmt::format("{:+.1f}", 100 * share);
}

Verdict verdict_of(bool within) {
    return within ? Verdict::within : Verdict::outside;
}

std::string level_name(std::uint32_t clusters) {
    return clusters == 0 ? "homogenised" : fmt::format("k = {}", clusters);
}

/// 6000 as "6,000".
std::string count_text(std::uint64_t count) {
    std::string text = std::to_string(count);
    for (std::size_t k = 3; k < text.size(); k += 4)
        text.insert(text.size() - k, ",");
    return text;
}

/// "scenario3" as "Sc. 3".
std::string short_name(const std::string& scenario) {
    return "Sc. " + scenario.substr(scenario.size() - 1);
}

DocumentCell ours(const PaperCell& cell) {
    if (cell.converged == 0) return {"no answer", Verdict::outside};
    std::string text = percent(cell.error.mean);
    if (cell.seeds > 1) text += fmt::format(" ±{:.1f}", 100 * cell.error.deviation);
    if (cell.converged < cell.seeds) text += fmt::format(" ({} not converged)", cell.seeds - cell.converged);
    return {text, verdict_of(cell.mean_is_within())};
}

DocumentCell papers(const PaperCell& cell) {
    if (!cell.paper) return {"", Verdict::none};
    return {percent(*cell.paper), verdict_of(cell.paper_is_within())};
}

// ---- Table 1

std::string times(double a, double b) {
    return fmt::format("{:.1f}x", a / b);
}

DocumentTable speed_table(const std::vector<SpeedRow>& rows) {
    DocumentTable table;
    table.columns = {"tetrahedra", "runtime us",       "range",    "speed-up", "baseline us", "range",
                     "speed-up",   "baseline/runtime", "paper ms", "speed-up"};
    for (const SpeedRow& row : rows) {
        const SpeedRow& first = rows.front();
        const auto range = [](const Statistic& us) {
            return fmt::format("{:.0f} to {:.0f}", us.lowest, us.highest);
        };
        table.rows.push_back({{count_text(row.tetrahedra)},
                              {fmt::format("{:.0f}", row.runtime_us.mean)},
                              {range(row.runtime_us)},
                              {times(first.runtime_us.mean, row.runtime_us.mean)},
                              {fmt::format("{:.0f}", row.baseline_us.mean)},
                              {range(row.baseline_us)},
                              {times(first.baseline_us.mean, row.baseline_us.mean)},
                              {times(row.baseline_us.mean, row.runtime_us.mean)},
                              {row.paper_ms ? fmt::format("{:.1f}", *row.paper_ms) : ""},
                              {row.paper_ms && first.paper_ms ? times(*first.paper_ms, *row.paper_ms) : ""}});
    }
    return table;
}

DocumentPart table1(const PaperSummary& summary) {
    DocumentPart part{"Table 1. Time of one step", {}, speed_table(summary.table1), {}};
    part.before = {
        "Median step of 1 ms under a press with a hand's tremor: median and range over the scenarios, first "
        "seed. "
        "The finest mesh has the raw elasticities, the others 2 bins and 3 clusters. Baseline: assembled "
        "matrix, "
        "conjugate gradients with block Jacobi, double precision, in turns with the runtime. Speed-ups are "
        "against "
        "the finest mesh of the same column group; they are the claim, the times belong to the machine."};
    return part;
}

// ---- Table 2

const PaperCell* find(const std::vector<PaperCell>& cells, const std::string& scene, std::uint32_t clusters,
                      std::uint64_t tetrahedra) {
    for (const PaperCell& cell : cells)
        if (cell.scene == scene && cell.clusters == clusters && cell.tetrahedra == tetrahedra) return &cell;
    return nullptr;
}

/// Rows of Table 2: number of clusters rising, finest mesh first.
std::set<std::pair<std::uint32_t, std::int64_t>> level_keys(const std::vector<PaperCell>& cells) {
    std::set<std::pair<std::uint32_t, std::int64_t>> keys;
    for (const PaperCell& cell : cells)
        keys.insert({cell.clusters, -static_cast<std::int64_t>(cell.tetrahedra)});
    return keys;
}

void add_reference_rows(const PaperSummary& summary, DocumentTable& table) {
    std::vector<DocumentCell> row{{"reference N"}}, paper{{"  paper"}};
    for (const RowCheck& check : summary.checks) {
        row.push_back({fmt::format("{:.2f} ±{:.2f}", check.reference_n.mean, check.reference_n.deviation)});
        paper.push_back({check.paper_reference_n ? fmt::format("{:.2f}", *check.paper_reference_n) : ""});
    }
    table.rows.push_back(row);
    table.rows.push_back(paper);
}

DocumentPart table2(const PaperSummary& summary) {
    DocumentPart part;
    part.heading = fmt::format("Table 2. Force error in %, {} seeds", summary.seeds);
    part.before = {
        fmt::format("Load press10, against the raw elasticities on 6,000 tetrahedra. Mean ± standard "
                    "deviation over the seeds; "
                    "below it the paper's. Mark and colour: outside the JND of {:g} % (ours: the mean).",
                    100 * kJndOfForce)};
    part.table.columns = {"level, tetrahedra"};
    for (const std::string& scene : summary.scenes)
        part.table.columns.push_back(short_name(scene));
    if (summary.checks.size() == summary.scenes.size()) add_reference_rows(summary, part.table);
    for (const auto& [clusters, minus_tetrahedra] : level_keys(summary.table2)) {
        const auto tetrahedra = static_cast<std::uint64_t>(-minus_tetrahedra);
        std::vector<DocumentCell> row{{level_name(clusters) + ", " + count_text(tetrahedra)}},
            paper{{"  paper"}};
        bool has_paper = false;
        for (const std::string& scene : summary.scenes) {
            const PaperCell* cell = find(summary.table2, scene, clusters, tetrahedra);
            row.push_back(cell ? ours(*cell) : DocumentCell{});
            paper.push_back(cell ? papers(*cell) : DocumentCell{});
            has_paper |= cell && cell->paper;
        }
        part.table.rows.push_back(row);
        if (has_paper) part.table.rows.push_back(paper);
    }
    return part;
}

// ---- How often, and how far from the paper

std::string share(double part, double whole) {
    return whole > 0 ? fmt::format("{:.0f} %", 100 * part / whole) : "";
}

std::vector<DocumentCell> count_row(const std::string& what, const PaperCount& count,
                                    const std::string& published) {
    const Statistic& seed = count.ours_of_seed;
    return {{what},
            {fmt::format("{} of {} ({})", count.ours, count.of,
                         share(static_cast<double>(count.ours), static_cast<double>(count.of)))},
            {fmt::format("{:.1f} ±{:.1f} ({:.0f} to {:.0f}; {})", seed.mean, seed.deviation, seed.lowest,
                         seed.highest, share(seed.mean, static_cast<double>(count.of)))},
            {fmt::format("{} of {} ({})", count.paper, count.paper_of,
                         share(static_cast<double>(count.paper), static_cast<double>(count.paper_of)))},
            {published}};
}

DocumentPart counts(const PaperSummary& summary) {
    DocumentPart part;
    part.heading = "Inside the JND";
    part.table.columns = {"", "ours, mean over seeds", "ours, each seed", "paper's Table 2", "paper's text"};
    part.table.rows = {count_row("cells with k = 1, 3, 6", summary.cells, ""),
                       count_row("(scenario, mesh) where some k is inside", summary.some_k,
                                 fmt::format("{:.0f} %", 100 * summary.some_k_works_in_paper))};
    return part;
}

DocumentPart differences(const PaperSummary& summary) {
    DocumentPart part;
    part.heading = "Ours against the paper's, cell by cell";
    part.table.columns = {"level",        "cells",
                          "same verdict", "RMS of ours - paper, points",
                          "mean, points", "seeds differ by (RMS sd), points"};
    std::size_t same = 0, cells = 0;
    for (const PaperDifference& difference : summary.differences) {
        part.table.rows.push_back({{level_name(difference.clusters)},
                                   {std::to_string(difference.cells)},
                                   {std::to_string(difference.same_verdict)},
                                   {fmt::format("{:.1f}", 100 * difference.root_mean_square)},
                                   {percent(difference.mean)},
                                   {fmt::format("{:.1f}", 100 * difference.deviation_of_seeds)}});
        if (difference.clusters == 0) continue;
        same += difference.same_verdict;
        cells += difference.cells;
    }
    part.after = {fmt::format(
        "Of the {} cells with clusters, ours and the paper's agree on the verdict in {}. Nothing was "
        "tuned to a cell; where they differ and why: docs/paper.md.",
        cells, same)};
    return part;
}

// ---- Figure 8

const CurveResult* reference_of(const std::vector<CurveResult>& curves) {
    for (const CurveResult& curve : curves)
        if (curve.method == "reference") return &curve;
    return nullptr;
}

std::string curve_name(const CurveResult& curve) {
    return curve.method == "homogenised" ? "homogenised" : level_name(curve.clusters);
}

DocumentPart figure8(const PaperSummary& summary) {
    constexpr std::size_t kRows = 10;
    DocumentPart part;
    part.heading = "Figure 8. Force over time, scenario 2, N";
    const CurveResult* reference = reference_of(summary.figure8);
    if (reference == nullptr) {
        part.before = {"Scenario 2 was not among the scenes."};
        return part;
    }
    std::vector<const CurveResult*> shown;
    for (const CurveResult& curve : summary.figure8)
        if (&curve != reference && curve.tetrahedra == reference->tetrahedra) shown.push_back(&curve);
    part.before = {
        "First seed, 6,000 tetrahedra, on the runtime: down by 10 % in 15 s, held for 5 s. All meshes and "
        "all points "
        "are in figure8.csv."};
    part.table.columns = {"time s", "reference", "JND from", "to"};
    for (const CurveResult* curve : shown)
        part.table.columns.push_back(curve_name(*curve));
    const std::vector<double>& force_n = reference->curve.force_n;
    for (std::size_t k = 1; k <= kRows; ++k) {
        const std::size_t at = k * force_n.size() / kRows - 1;
        const double wanted = force_n[at];
        std::vector<DocumentCell> row{{fmt::format("{:.1f}", reference->curve.time_s[at])},
                                      {fmt::format("{:.2f}", wanted)},
                                      {fmt::format("{:.2f}", wanted * (1 - kJndOfForce))},
                                      {fmt::format("{:.2f}", wanted * (1 + kJndOfForce))}};
        for (const CurveResult* curve : shown)
            row.push_back({fmt::format("{:.2f}", curve->curve.force_n[at]),
                           verdict_of(std::abs(curve->curve.force_n[at] / wanted - 1) <= kJndOfForce)});
        part.table.rows.push_back(row);
    }
    return part;
}

// ---- The steak

std::vector<DocumentPart> steak(const PaperSummary& summary) {
    if (summary.steak.empty()) return {{"The steak", {"The steak was not among the scenes."}, {}, {}}};
    DocumentPart force, speed;
    force.heading = fmt::format("The steak: force error in %, {} seeds", summary.seeds);
    force.before = {
        "Pressed by the spatula by 10 % of the height, against the raw elasticities on the fine mesh."};
    force.table.columns = {"level, tetrahedra",    "ours",         "lowest", "highest",
                           "seeds inside the JND", "paper |error|"};
    for (const PaperCell& cell : summary.steak)
        force.table.rows.push_back({{level_name(cell.clusters) + ", " + count_text(cell.tetrahedra)},
                                    ours(cell),
                                    {percent(cell.error.lowest)},
                                    {percent(cell.error.highest)},
                                    {fmt::format("{} of {}", cell.within, cell.seeds)},
                                    {cell.paper ? fmt::format("{:.0f}", 100 * std::abs(*cell.paper)) : "",
                                     cell.paper ? verdict_of(cell.paper_is_within()) : Verdict::none}});
    std::string meeting;
    for (const PaperCell& cell : summary.steak)
        if (cell.clusters > 0 && cell.mean_is_within())
            meeting += (meeting.empty() ? "" : ", ") + level_name(cell.clusters);
    force.after = {
        "Inside the JND by the mean of ours: " + (meeting.empty() ? "none" : meeting) +
        ". The paper says of its steak: 50 % with one cluster, 5 % with three, without a sign; its mesh "
        "and tool are not published. k = 10 is not in the paper."};
    speed = {"The steak: time of one step", {}, speed_table(summary.steak_speed), {}};
    return {force, speed};
}

// ---- What every solver should agree on

DocumentPart checks(const PaperSummary& summary) {
    DocumentPart part;
    part.heading = "Checks: reference and homogenised rows";
    part.before = {fmt::format(
        "Expected: a separate solver on other draws (docs/reference.md). Ok: reference within {:g} %, "
        "homogenised within {:g} points.",
        100 * kReferenceTolerance, 100 * kHomogenisedTolerance)};
    part.table.columns = {"scenario", "row", "ours", "expected", "difference", "", "paper"};
    for (const RowCheck& check : summary.checks) {
        const double error = check.homogenised.error.mean;
        const auto word = [](bool ok) { return std::string(ok ? "ok" : "NOT OK"); };
        part.table.rows.push_back(
            {{check.scene},
             {"reference N"},
             {fmt::format("{:.2f}", check.reference_n.mean)},
             {fmt::format("{:.2f}", check.expected_reference_n)},
             {percent(check.reference_n.mean / check.expected_reference_n - 1) + " %"},
             {word(check.reference_is_ok()), verdict_of(check.reference_is_ok())},
             {check.paper_reference_n ? fmt::format("{:.2f}", *check.paper_reference_n) : ""}});
        part.table.rows.push_back({{check.scene},
                                   {"homogenised %"},
                                   {percent(error)},
                                   {percent(check.expected_homogenised)},
                                   {percent(error - check.expected_homogenised) + " points"},
                                   {word(check.homogenised_is_ok()), verdict_of(check.homogenised_is_ok())},
                                   {check.homogenised.paper ? percent(*check.homogenised.paper) : ""}});
    }
    const Disagreement& worst = summary.disagreement;
    part.after = {
        fmt::format("Runtime and reference solver, {} results in which both ran: largest relative difference "
                    "of the force "
                    "{:.1e} ({}); wanted at most {:.0e}: {}.",
                    worst.compared, worst.largest, worst.where, kRuntimeAgreement,
                    worst.largest <= kRuntimeAgreement ? "ok" : "NOT OK")};
    return part;
}

DocumentPart about(const PaperRun& run) {
    DocumentPart part;
    part.heading = "How these numbers were made";
    part.after = {"Command: `" + run.command + "`.",
                  fmt::format("Date {}, commit {}. Machine: {}; {}; {}; load average {:.1f} at the start. "
                              "This run took {:.0f} s; what "
                              "an earlier, interrupted run kept is not computed again.",
                              run.date, run.commit, run.machine.cpu, run.machine.os, run.machine.compiler,
                              run.machine.load_average, run.seconds)};
    return part;
}

}  // namespace

std::vector<DocumentPart> paper_document(const PaperSummary& summary, const PaperRun& run) {
    std::vector<DocumentPart> parts{table1(summary), table2(summary), counts(summary), differences(summary),
                                    figure8(summary)};
    for (DocumentPart& part : steak(summary))
        parts.push_back(std::move(part));
    parts.push_back(checks(summary));
    parts.push_back(about(run));
    return parts;
}

}  // namespace knead::tools
