// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/paper/published.h"

#include <exception>

#include "common/error.h"
#include "evaluate/whole_number.h"

namespace knead::tools {
namespace {

using Json = nlohmann::ordered_json;

/// "homogenised" is 0, "k3" is 3.
std::uint32_t clusters_of(const std::string& method) {
    return method == "homogenised" ? 0 : static_cast<std::uint32_t>(std::stoul(method.substr(1)));
}

PublishedPaper::Cell cell_of(const Json& json, const std::string& scene) {
    return {scene, whole_number<std::uint64_t>(json.at("tets")),
            clusters_of(json.at("method").get<std::string>()), json.at("value_percent").get<double>() / 100};
}

PublishedPaper read_all(const Json& json) {
    PublishedPaper paper;
    for (const Json& row : json.at("table1"))
        paper.step_ms[whole_number<std::uint64_t>(row.at("tets"))] = row.at("time_ms").get<double>();
    for (const Json& row : json.at("table2")) {
        const auto scene = row.at("scene").get<std::string>();
        if (row.at("method") == "reference")
            paper.reference_n[scene] = row.at("force_n").get<double>();
        else
            paper.table2.push_back(cell_of(row, scene));
    }
    for (const Json& row : json.at("steak").at("rows"))
        paper.steak.push_back(cell_of(row, "steak"));
    for (const Json& row : json.at("steak").at("rate_hz"))
        paper.steak_step_ms[whole_number<std::uint64_t>(row.at("tets"))] =
            1000 / row.at("value").get<double>();
    for (const Json& row : json.at("expected"))
        paper.expected.push_back({row.at("scene").get<std::string>(), row.at("reference_n").get<double>(),
                                  row.at("homogenised_percent").get<double>() / 100});
    paper.some_k_works = json.at("summary").at("some_k_works_percent").get<double>() / 100;
    return paper;
}

}  // namespace

std::optional<double> PublishedPaper::error_of(const std::string& scene, std::uint64_t tetrahedra,
                                               std::uint32_t clusters) const {
    for (const Cell& cell : table2)
        if (cell.scene == scene && cell.tetrahedra == tetrahedra && cell.clusters == clusters)
            return cell.error;
    for (const Cell& cell : steak)
        if (cell.scene == scene && cell.clusters == clusters) return cell.error;
    return std::nullopt;
}

PublishedPaper published_paper(const Json& json) {
    try {
        return read_all(json);
    } catch (const std::exception& error) {
        fail_result(std::string("paper.json: a published number is missing: ") + error.what());
    }
}

}  // namespace knead::tools
