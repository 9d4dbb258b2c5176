// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evaluate/cell_json.h"
#include "knead/formats/version.h"

namespace knead::tools {
namespace {

using Json = nlohmann::ordered_json;

bool same_row(const CellResult& a, const CellResult& b) {
    return a.load == b.load && a.method == b.method && a.tetrahedra == b.tetrahedra;
}

void add(Spread& row, const CellResult& cell) {
    ++row.seeds;
    row.reference_force_n += cell.reference_force_n;
    if (!cell.converged) return;
    ++row.converged;
    row.within_jnd += cell.within_jnd() ? 1 : 0;
    row.lowest = row.converged == 1 ? cell.force_error : std::min(row.lowest, cell.force_error);
    row.highest = row.converged == 1 ? cell.force_error : std::max(row.highest, cell.force_error);
    row.mean += cell.force_error;
    row.deviation += cell.force_error * cell.force_error;
    row.displacement_error += cell.displacement_error;
    row.force_n += cell.force_n;
}

void finish(Spread& row) {
    row.reference_force_n /= static_cast<double>(row.seeds);
    if (row.converged == 0) return;
    const auto count = static_cast<double>(row.converged);
    const double squares = row.deviation;
    row.mean /= count;
    row.displacement_error /= count;
    row.force_n /= count;
    row.deviation = row.converged == 1
                        ? 0
                        : std::sqrt(std::max(0.0, (squares - count * row.mean * row.mean) / (count - 1)));
}

std::string row_text(const Spread& row) {
    const CellResult& cell = *row.first;
    const std::string name = cell.method.text() + (cell.fitted ? " *" : "");
    if (row.converged == 0)
        return fmt::format("  {:<8} {:>6} {:<16} did not converge: {}\n", cell.load, cell.tetrahedra, name,
                           cell.problem);
    std::string line = fmt::format(
        "  {:<8} {:>6} {:<16} {:>9.4g} {:>9.4g} {:>+8.1f} {:>6.1f} {:>+8.1f} {:>+8.1f} {:>6}/{:<3} {:>6.1f}",
        cell.load, cell.tetrahedra, name, row.reference_force_n, row.force_n, 100 * row.mean,
        100 * row.deviation, 100 * row.lowest, 100 * row.highest, row.within_jnd, row.seeds,
        100 * row.displacement_error);
    if (cell.step) line += fmt::format(" {:>8.1f} {:>8.1f}", cell.step->p50_us, cell.step->p99_us);
    if (cell.load_ms) line += fmt::format(" {:>7.2f}", *cell.load_ms);
    if (cell.asset_bytes) line += fmt::format(" {:>9}", *cell.asset_bytes);
    if (row.converged < row.seeds) line += fmt::format("  {} not converged", row.seeds - row.converged);
    return line + "\n";
}

constexpr const char* kHeader =
    "  load       tets method               ref N    N mean   err %     sd   lowest  highest in JND    disp "
    "%   "
    "p50 us   p99 us load ms     bytes\n";

Json state_json(const ObjectState& state) {
    Json json{{"name", state.name}};
    Json& nodes = json["nodes_m"] = Json::array();
    for (const Point& node : state.object.mesh.nodes_m)
        for (const double x : node)
            nodes.push_back(x);
    Json& tetrahedra = json["tetrahedra"] = Json::array();
    for (const Tetrahedron& tetrahedron : state.object.mesh.tetrahedra)
        for (const std::uint32_t node : tetrahedron)
            tetrahedra.push_back(node);
    json["youngs_modulus_pa"] = state.object.material.youngs_modulus_pa;
    if (!state.object.material.bin_of_tetrahedron.empty())
        json["bin"] = state.object.material.bin_of_tetrahedron;
    if (!state.cluster.empty()) json["cluster"] = state.cluster;
    return json;
}

Json group_json(const AssetGroup& group) {
    return {{"group", group.group},
            {"bytes", group.bytes},
            {"asked_for_by", group.asked_for_by},
            {"left_out", group.left_out},
            {"why", group.why}};
}

}  // namespace

std::vector<Spread> spreads(const SceneResult& scene) {
    std::vector<Spread> rows;
    for (const CellResult& cell : scene.cells) {
        if (rows.empty() || !same_row(*rows.back().first, cell)) {
            rows.emplace_back();
            rows.back().first = &cell;
        }
        add(rows.back(), cell);
    }
    for (Spread& row : rows)
        finish(row);
    return rows;
}

std::string text_report(const std::vector<SceneResult>& scenes) {
    std::string text;
    for (const SceneResult& scene : scenes) {
        text += fmt::format("{}: errors against {} tetrahedra ({} mesh, raw elasticities)\n", scene.name,
                            scene.reference_tetrahedra, name_of(scene.reference));
        text += kHeader;
        for (const Spread& row : spreads(scene))
            text += row_text(row);
        for (const std::string& note : scene.notes)
            text += "  " + note + "\n";
        text += "\n";
    }
    return text;
}

nlohmann::ordered_json json_report(const std::vector<SceneResult>& scenes, const baseline::Machine& machine,
                                   const std::string& commit, const std::string& command) {
    Json json;
    json["schema"] = "knead-evaluation/1";
    json["version"] = kLibraryVersion;
    json["machine"] = {{"cpu", machine.cpu},
                       {"compiler", machine.compiler},
                       {"os", machine.os},
                       {"load_average", machine.load_average}};
    json["commit"] = commit;
    json["command"] = command;
    json["scenes"] = Json::array();
    for (const SceneResult& scene : scenes) {
        Json one;
        one["name"] = scene.name;
        one["reference"] = {{"tets", scene.reference_tetrahedra}, {"kind", name_of(scene.reference)}};
        one["results"] = Json::array();
        for (const CellResult& cell : scene.cells)
            one["results"].push_back(to_json(cell));
        for (const CurveResult& curve : scene.curves)
            one["curves"].push_back({{"method", curve.method},
                                     {"bins", curve.bins},
                                     {"clusters", curve.clusters},
                                     {"tets", curve.tetrahedra},
                                     {"seed", curve.seed},
                                     {"load", curve.load},
                                     {"time_s", curve.curve.time_s},
                                     {"force_n", curve.curve.force_n}});
        for (const SpeedResult& speed : scene.speed)
            one["speed"].push_back(to_json(speed));
        for (const ObjectState& state : scene.states)
            one["states"].push_back(state_json(state));
        for (const AssetGroup& group : scene.asset)
            one["asset"].push_back(group_json(group));
        if (!scene.notes.empty()) one["notes"] = scene.notes;
        json["scenes"].push_back(std::move(one));
    }
    return json;
}

std::string csv_report(const std::vector<SceneResult>& scenes) {
    std::string text =
        "scene,reference_tets,reference_kind,method,bins,clusters,tets,seed,load,fitted,force_n,"
        "reference_force_n,force_error,displacement_error,within_jnd,converged,step_p50_us,step_p99_us,"
        "step_p999_us,step_max_us,load_ms,asset_bytes,runtime_force_n\n";
    const auto number = [](const auto& value) { return value ? fmt::format("{}", *value) : std::string(); };
    for (const SceneResult& scene : scenes)
        for (const CellResult& cell : scene.cells) {
            const auto if_converged = [&](double value) {
                return cell.converged ? fmt::format("{}", value) : std::string();
            };
            text += fmt::format(
                "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},", scene.name, scene.reference_tetrahedra,
                name_of(scene.reference), name_of(cell.method.kind), cell.method.bins, cell.method.clusters,
                cell.tetrahedra, cell.seed, cell.load, cell.fitted, if_converged(cell.force_n),
                cell.reference_force_n, if_converged(cell.force_error), if_converged(cell.displacement_error),
                cell.within_jnd(), cell.converged);
            text += cell.step ? fmt::format("{},{},{},{},", cell.step->p50_us, cell.step->p99_us,
                                            cell.step->p999_us, cell.step->max_us)
                              : ",,,,";
            text += number(cell.load_ms) + "," + number(cell.asset_bytes) + "," +
                    number(cell.runtime_force_n) + "\n";
        }
    return text;
}

std::string disagreements(const std::vector<SceneResult>& scenes) {
    constexpr std::size_t kShown = 5;
    std::string text;
    std::size_t count = 0;
    for (const SceneResult& scene : scenes)
        for (const CellResult& cell : scene.cells) {
            if (!(cell.runtime_disagreement() > kRuntimeAgreement)) continue;
            if (++count > kShown) continue;
            text += fmt::format("{}{} {} on {} tetrahedra, {}, seed {}: {:.6g} N, solver {:.6g} N",
                                count > 1 ? "; " : "", scene.name, cell.method.text(), cell.tetrahedra,
                                cell.load, cell.seed, *cell.runtime_force_n, cell.force_n);
        }
    if (count > kShown) text += fmt::format("; and {} more", count - kShown);
    return text;
}

std::size_t count_above(const std::vector<SceneResult>& scenes, double limit) {
    std::size_t count = 0;
    for (const SceneResult& scene : scenes)
        for (const CellResult& cell : scene.cells)
            if (!cell.converged || std::abs(cell.force_error) > limit) ++count;
    return count;
}

}  // namespace knead::tools
