// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/paper/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "evaluate/paper/run.h"
#include "evaluate/tables.h"

namespace knead::tools {
namespace {

std::uint32_t clusters_of(const Method& method) {
    return method.kind == MethodKind::homogenised ? 0 : method.clusters;
}

PaperCell cell_of(const SceneResult& scene, const Spread& row, const PublishedPaper& published) {
    PaperCell cell;
    cell.scene = scene.name;
    cell.tetrahedra = row.first->tetrahedra;
    cell.clusters = clusters_of(row.first->method);
    cell.seeds = row.seeds;
    cell.converged = row.converged;
    cell.within = row.within_jnd;
    cell.error = {row.mean, row.deviation, row.lowest, row.highest};
    cell.paper = published.error_of(cell.scene, cell.tetrahedra, cell.clusters);
    return cell;
}

RowCheck check_of(const SceneResult& scene, const PaperCell& homogenised,
                  const PublishedPaper::ExpectedRow& expected, const PublishedPaper& published) {
    RowCheck check;
    check.scene = scene.name;
    std::map<std::uint64_t, double> reference_of_seed;
    for (const CellResult& cell : scene.cells)
        reference_of_seed[cell.seed] = cell.reference_force_n;
    std::vector<double> forces_n;
    for (const auto& [seed, force_n] : reference_of_seed)
        forces_n.push_back(force_n);
    check.reference_n = statistic_of(forces_n);
    check.homogenised = homogenised;
    check.expected_reference_n = expected.reference_n;
    check.expected_homogenised = expected.homogenised_error;
    if (const auto at = published.reference_n.find(scene.name); at != published.reference_n.end())
        check.paper_reference_n = at->second;
    return check;
}

using Pair = std::pair<std::string, std::uint64_t>;  // scene, tetrahedra

/// Numbers of cells and of (scene, mesh) pairs with some k inside, for every seed.
struct SeedCounts {
    std::map<std::uint64_t, std::size_t> cells;
    std::map<std::uint64_t, std::set<Pair>> pairs;
};

SeedCounts count_seeds(const std::vector<SceneResult>& scenes) {
    SeedCounts counts;
    for (const SceneResult& scene : scenes) {
        if (!is_scenario(scene.name)) continue;
        for (const CellResult& cell : scene.cells) {
            if (cell.method.kind != MethodKind::paper) continue;
            counts.cells[cell.seed] += cell.within_jnd() ? 1 : 0;
            std::set<Pair>& pairs = counts.pairs[cell.seed];
            if (cell.within_jnd()) pairs.insert({scene.name, cell.tetrahedra});
        }
    }
    return counts;
}

void count(const std::vector<SceneResult>& scenes, PaperSummary& summary) {
    std::set<Pair> pairs, ours, paper;
    for (const PaperCell& cell : summary.table2) {
        if (cell.clusters == 0) continue;
        const Pair pair{cell.scene, cell.tetrahedra};
        pairs.insert(pair);
        ++summary.cells.of;
        if (cell.mean_is_within()) {
            ++summary.cells.ours;
            ours.insert(pair);
        }
        summary.cells.paper_of += cell.paper ? 1 : 0;
        if (cell.paper_is_within()) {
            ++summary.cells.paper;
            paper.insert(pair);
        }
    }
    summary.some_k.of = summary.some_k.paper_of = pairs.size();
    summary.some_k.ours = ours.size();
    summary.some_k.paper = paper.size();
    const SeedCounts seeds = count_seeds(scenes);
    std::vector<double> cells_of_seed, pairs_of_seed;
    for (const auto& [seed, number] : seeds.cells)
        cells_of_seed.push_back(static_cast<double>(number));
    for (const auto& [seed, found] : seeds.pairs)
        pairs_of_seed.push_back(static_cast<double>(found.size()));
    summary.cells.ours_of_seed = statistic_of(cells_of_seed);
    summary.some_k.ours_of_seed = statistic_of(pairs_of_seed);
}

std::vector<PaperDifference> differences_of(const std::vector<PaperCell>& cells) {
    std::map<std::uint32_t, PaperDifference> by_clusters;
    for (const PaperCell& cell : cells) {
        if (!cell.paper) continue;
        PaperDifference& sum = by_clusters[cell.clusters];
        const double difference = cell.error.mean - *cell.paper;
        ++sum.cells;
        sum.same_verdict += cell.mean_is_within() == cell.paper_is_within() ? 1 : 0;
        sum.mean += difference;
        sum.root_mean_square += difference * difference;
        sum.deviation_of_seeds += cell.error.deviation * cell.error.deviation;
    }
    std::vector<PaperDifference> differences;
    for (auto& [clusters, sum] : by_clusters) {
        const auto number = static_cast<double>(sum.cells);
        sum.clusters = clusters;
        sum.mean /= number;
        sum.root_mean_square = std::sqrt(sum.root_mean_square / number);
        sum.deviation_of_seeds = std::sqrt(sum.deviation_of_seeds / number);
        differences.push_back(sum);
    }
    return differences;
}

/// As statistic_of(), with the median for the mean: one disturbed measurement does not move it.
Statistic median_of(std::vector<double> values) {
    Statistic statistic = statistic_of(values);
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    statistic.mean = values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
    return statistic;
}

/// The steak's mesher does not meet the paper's number of tetrahedra exactly.
bool is_same_mesh(std::uint64_t papers, std::uint64_t ours) {
    constexpr double kTolerance = 0.03;
    return std::abs(static_cast<double>(ours) / static_cast<double>(papers) - 1) <= kTolerance;
}

/// Finest mesh first.
std::vector<SpeedRow> speed_rows(const std::vector<const SceneResult*>& scenes,
                                 const std::map<std::uint64_t, double>& paper_ms) {
    std::map<std::uint64_t, std::pair<std::vector<double>, std::vector<double>>> times;
    for (const SceneResult* scene : scenes)
        for (const SpeedResult& speed : scene->speed) {
            times[speed.tetrahedra].first.push_back(speed.times.runtime.p50_us);
            times[speed.tetrahedra].second.push_back(speed.times.baseline.p50_us);
        }
    std::vector<SpeedRow> rows;
    for (auto at = times.rbegin(); at != times.rend(); ++at) {
        SpeedRow row{at->first, median_of(at->second.first), median_of(at->second.second), std::nullopt};
        for (const auto& [tetrahedra, ms] : paper_ms)
            if (is_same_mesh(tetrahedra, at->first)) row.paper_ms = ms;
        rows.push_back(row);
    }
    return rows;
}

Disagreement disagreement_of(const std::vector<SceneResult>& scenes) {
    Disagreement result;
    for (const SceneResult& scene : scenes)
        for (const CellResult& cell : scene.cells) {
            if (!cell.runtime_force_n) continue;
            ++result.compared;
            if (cell.runtime_disagreement() < result.largest) continue;
            result.largest = cell.runtime_disagreement();
            result.where = fmt::format("{}, {}, {} tetrahedra, seed {}", scene.name, cell.method.text(),
                                       cell.tetrahedra, cell.seed);
        }
    return result;
}

}  // namespace

Statistic statistic_of(const std::vector<double>& values) {
    if (values.empty()) return {};
    Statistic statistic;
    const auto number = static_cast<double>(values.size());
    for (const double value : values)
        statistic.mean += value / number;
    for (const double value : values)
        statistic.deviation += (value - statistic.mean) * (value - statistic.mean);
    statistic.deviation = values.size() == 1 ? 0 : std::sqrt(statistic.deviation / (number - 1));
    statistic.lowest = *std::min_element(values.begin(), values.end());
    statistic.highest = *std::max_element(values.begin(), values.end());
    return statistic;
}

bool PaperCell::mean_is_within() const {
    return converged == seeds && std::abs(error.mean) <= kJndOfForce;
}

bool PaperCell::paper_is_within() const {
    return paper && std::abs(*paper) <= kJndOfForce;
}

bool RowCheck::reference_is_ok() const {
    return std::abs(reference_n.mean / expected_reference_n - 1) <= kReferenceTolerance;
}

bool RowCheck::homogenised_is_ok() const {
    return homogenised.converged == homogenised.seeds &&
           std::abs(homogenised.error.mean - expected_homogenised) <= kHomogenisedTolerance;
}

bool PaperSummary::rows_are_ok() const {
    return std::all_of(checks.begin(), checks.end(), [](const RowCheck& check) {
        return check.reference_is_ok() && check.homogenised_is_ok();
    });
}

PaperSummary summarise_paper(const std::vector<SceneResult>& scenes, const PublishedPaper& published) {
    PaperSummary summary;
    std::vector<const SceneResult*> cubes, steaks;
    for (const SceneResult& scene : scenes) {
        const bool is_cube = is_scenario(scene.name);
        (is_cube ? cubes : steaks).push_back(&scene);
        if (is_cube) summary.scenes.push_back(scene.name);
        if (scene.name == kFigure8Scene) summary.figure8 = scene.curves;
        for (const Spread& row : spreads(scene)) {
            const PaperCell cell = cell_of(scene, row, published);
            (is_cube ? summary.table2 : summary.steak).push_back(cell);
            summary.seeds = std::max(summary.seeds, static_cast<std::uint32_t>(row.seeds));
            if (cell.clusters != 0 || cell.tetrahedra != scene.reference_tetrahedra) continue;
            for (const auto& expected : published.expected)
                if (expected.scene == scene.name)
                    summary.checks.push_back(check_of(scene, cell, expected, published));
        }
    }
    count(scenes, summary);
    summary.differences = differences_of(summary.table2);
    summary.table1 = speed_rows(cubes, published.step_ms);
    summary.steak_speed = speed_rows(steaks, published.steak_step_ms);
    summary.disagreement = disagreement_of(scenes);
    summary.some_k_works_in_paper = published.some_k_works;
    return summary;
}

}  // namespace knead::tools
