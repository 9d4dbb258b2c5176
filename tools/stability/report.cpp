// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability/report.h"

#include <fmt/format.h>

#include <cmath>

namespace knead::tools::stability {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no NaN nor infinity.
Json number(double value) {
    if (std::isfinite(value)) return value;
    return std::isnan(value) ? Json(nullptr) : Json(value > 0 ? "inf" : "-inf");
}

Json check_json(const Check& check) {
    Json json{{"value", number(check.value)},
              {"bound", number(check.bound)},
              {"unit", check.unit},
              {"status", name_of(check.status)}};
    if (!check.note.empty()) json["note"] = check.note;
    return json;
}

/// What is shown for the cell: of a good one what it is about, else what is wrong.
const Check& shown(const CellResult& cell) {
    return cell.status() == CellStatus::pass ? cell.checks.front() : cell.decisive();
}

std::string advice_text(const CellResult& cell) {
    std::string text;
    for (const Warning warning : cell.warnings())
        text += fmt::format("{}{}", text.empty() ? "" : "; ", advice_for(warning).action);
    return text;
}

std::string reason_text(const CellResult& cell) {
    std::string text;
    for (const Check& check : cell.checks) {
        if (check.status == CellStatus::pass) continue;
        const std::string kind = check.warning == Warning::none ? check.name : name_of(check.warning);
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", kind, check.note);
    }
    return text;
}

Json cell_json(const CellResult& cell) {
    const Check& main = shown(cell);
    Json checks = Json::object();
    for (const Check& check : cell.checks)
        checks[check.name] = check_json(check);
    Json warnings = Json::array();
    for (const Warning warning : cell.warnings())
        warnings.push_back(name_of(warning));
    return {{"case", cell.name},           {"family", cell.family},       {"status", name_of(cell.status())},
            {"check", main.name},          {"value", number(main.value)}, {"unit", main.unit},
            {"bound", number(main.bound)}, {"steps", cell.steps},         {"checks", checks},
            {"warnings", warnings},        {"reason", reason_text(cell)}, {"advice", advice_text(cell)}};
}

}  // namespace

StabilityCounts count_of(const std::vector<CellResult>& cells) {
    StabilityCounts counts;
    for (const CellResult& cell : cells) {
        const CellStatus status = cell.status();
        (status == CellStatus::pass ? counts.pass : status == CellStatus::warn ? counts.warn : counts.fail)++;
    }
    return counts;
}

Json stability_json(const std::vector<CellResult>& cells, const StabilityProvenance& provenance) {
    const StabilityCounts counts = count_of(cells);
    Json list = Json::array();
    for (const CellResult& cell : cells)
        list.push_back(cell_json(cell));
    Json warnings = Json::object();
    for (const Warning warning : all_warnings())
        warnings[name_of(warning)] = {{"cause", advice_for(warning).cause},
                                      {"advice", advice_for(warning).action}};
    return {{"schema", "knead-stability/1"},
            {"machine", provenance.machine},
            {"commit", provenance.commit},
            {"command", provenance.command},
            {"counts", {{"pass", counts.pass}, {"warn", counts.warn}, {"fail", counts.fail}}},
            {"cells", list},
            {"warnings", warnings}};
}

std::string stability_table(const std::vector<CellResult>& cells) {
    std::size_t width = 0;
    for (const CellResult& cell : cells)
        width = std::max(width, cell.name.size());
    std::string text;
    for (const CellResult& cell : cells) {
        const Check& main = shown(cell);
        text += fmt::format("{:<4}  {:<{}}  {:<18} {:>9.2g}  at most {:.3g} {}\n", name_of(cell.status()),
                            cell.name, width, main.name, main.value, main.bound, main.unit);
        if (cell.status() != CellStatus::pass) text += fmt::format("      {}\n", reason_text(cell));
    }
    const StabilityCounts counts = count_of(cells);
    text += fmt::format("{} cells: {} pass, {} with a warning, {} fail\n", cells.size(), counts.pass,
                        counts.warn, counts.fail);
    return text;
}

}  // namespace knead::tools::stability
