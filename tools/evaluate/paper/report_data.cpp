// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's tables for programs: JSON and CSV.
#include <fmt/format.h>

#include "evaluate/paper/report.h"

namespace knead::tools {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Statistic& statistic) {
    return {{"mean", statistic.mean},
            {"sd", statistic.deviation},
            {"lowest", statistic.lowest},
            {"highest", statistic.highest}};
}

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json json_of(const PaperCell& cell) {
    return {{"scene", cell.scene},
            {"tets", cell.tetrahedra},
            {"clusters", cell.clusters},
            {"seeds", cell.seeds},
            {"converged", cell.converged},
            {"seeds_within_jnd", cell.within},
            {"force_error", json_of(cell.error)},
            {"within_jnd", cell.mean_is_within()},
            {"paper", or_null(cell.paper)}};
}

Json json_of(const SpeedRow& row) {
    const auto times = [](const Statistic& us) {
        return Json{{"median", us.mean}, {"lowest", us.lowest}, {"highest", us.highest}};
    };
    return {{"tets", row.tetrahedra},
            {"runtime_us", times(row.runtime_us)},
            {"baseline_us", times(row.baseline_us)},
            {"paper_ms", or_null(row.paper_ms)}};
}

Json json_of(const PaperCount& count) {
    return {{"of", count.of},
            {"ours", count.ours},
            {"ours_of_each_seed", json_of(count.ours_of_seed)},
            {"paper_of", count.paper_of},
            {"paper", count.paper}};
}

Json json_of(const PaperDifference& difference) {
    return {{"clusters", difference.clusters},
            {"cells", difference.cells},
            {"same_verdict", difference.same_verdict},
            {"rms", difference.root_mean_square},
            {"mean", difference.mean},
            {"rms_sd_of_seeds", difference.deviation_of_seeds}};
}

Json json_of(const RowCheck& check) {
    return {{"scene", check.scene},
            {"reference_n", json_of(check.reference_n)},
            {"expected_reference_n", check.expected_reference_n},
            {"paper_reference_n", or_null(check.paper_reference_n)},
            {"reference_ok", check.reference_is_ok()},
            {"homogenised", json_of(check.homogenised.error)},
            {"expected_homogenised", check.expected_homogenised},
            {"paper_homogenised", or_null(check.homogenised.paper)},
            {"homogenised_ok", check.homogenised_is_ok()}};
}

template <class Items>
Json list_of(const Items& items) {
    Json list = Json::array();
    for (const auto& item : items)
        list.push_back(json_of(item));
    return list;
}

template <class T>
std::string text_or_nothing(const std::optional<T>& value) {
    return value ? fmt::format("{}", *value) : std::string();
}

}  // namespace

Json to_json(const PaperSummary& summary) {
    return {{"seeds", summary.seeds},
            {"table1", list_of(summary.table1)},
            {"table2", list_of(summary.table2)},
            {"cells_within_jnd", json_of(summary.cells)},
            {"some_k_within_jnd", json_of(summary.some_k)},
            {"differences_to_paper", list_of(summary.differences)},
            {"steak", list_of(summary.steak)},
            {"steak_speed", list_of(summary.steak_speed)},
            {"checks", list_of(summary.checks)},
            {"runtime_against_reference_solver",
             {{"compared", summary.disagreement.compared},
              {"largest", summary.disagreement.largest},
              {"where", summary.disagreement.where}}}};
}

std::string table1_csv(const PaperSummary& summary) {
    std::string text =
        "object,tets,runtime_us,runtime_lowest_us,runtime_highest_us,baseline_us,"
        "baseline_lowest_us,baseline_highest_us,paper_ms\n";
    const auto add = [&](const char* object, const std::vector<SpeedRow>& rows) {
        for (const SpeedRow& row : rows)
            text += fmt::format("{},{},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{}\n", object,
                                row.tetrahedra, row.runtime_us.mean, row.runtime_us.lowest,
                                row.runtime_us.highest, row.baseline_us.mean, row.baseline_us.lowest,
                                row.baseline_us.highest, text_or_nothing(row.paper_ms));
    };
    add("scenarios", summary.table1);
    add("steak", summary.steak_speed);
    return text;
}

std::string table2_csv(const PaperSummary& summary) {
    std::string text =
        "scene,row,clusters,tets,seeds,converged,seeds_within_jnd,mean,sd,lowest,highest,paper\n";
    for (const RowCheck& check : summary.checks)
        text += fmt::format("{},reference_n,,{},{},{},,{:.6g},{:.4g},{:.6g},{:.6g},{}\n", check.scene,
                            check.homogenised.tetrahedra, check.homogenised.seeds, check.homogenised.seeds,
                            check.reference_n.mean, check.reference_n.deviation, check.reference_n.lowest,
                            check.reference_n.highest, text_or_nothing(check.paper_reference_n));
    for (const auto* cells : {&summary.table2, &summary.steak})
        for (const PaperCell& cell : *cells)
            text += fmt::format("{},force_error,{},{},{},{},{},{:.5f},{:.5f},{:.5f},{:.5f},{}\n", cell.scene,
                                cell.clusters, cell.tetrahedra, cell.seeds, cell.converged, cell.within,
                                cell.error.mean, cell.error.deviation, cell.error.lowest, cell.error.highest,
                                text_or_nothing(cell.paper));
    return text;
}

std::string figure8_csv(const PaperSummary& summary) {
    std::string text = "method,clusters,tets,seed,time_s,force_n\n";
    for (const CurveResult& curve : summary.figure8)
        for (std::size_t k = 0; k < curve.curve.time_s.size(); ++k)
            text += fmt::format("{},{},{},{},{:.3f},{:.6g}\n", curve.method, curve.clusters, curve.tetrahedra,
                                curve.seed, curve.curve.time_s[k], curve.curve.force_n[k]);
    return text;
}

}  // namespace knead::tools
