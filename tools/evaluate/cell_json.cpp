// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/cell_json.h"

namespace knead::tools {
namespace {

using Json = nlohmann::ordered_json;

Json step_json(const StepTimes& step) {
    return {{"p50", step.p50_us}, {"p99", step.p99_us}, {"p999", step.p999_us}, {"max", step.max_us}};
}

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

}  // namespace

nlohmann::ordered_json to_json(const CellResult& cell) {
    Json json;
    json["method"] = name_of(cell.method.kind);
    json["bins"] = cell.method.bins;
    json["clusters"] = cell.method.clusters;
    json["tets"] = cell.tetrahedra;
    json["seed"] = cell.seed;
    json["load"] = cell.load;
    json["fitted"] = cell.fitted;
    json["force_n"] = cell.converged ? Json(cell.force_n) : Json(nullptr);
    json["reference_force_n"] = cell.reference_force_n;
    json["force_error"] = cell.converged ? Json(cell.force_error) : Json(nullptr);
    json["displacement_error"] = cell.converged ? Json(cell.displacement_error) : Json(nullptr);
    json["within_jnd"] = cell.within_jnd();
    json["converged"] = cell.converged;
    if (!cell.problem.empty()) json["problem"] = cell.problem;
    json["step_us"] = cell.step ? step_json(*cell.step) : Json(nullptr);
    json["load_ms"] = or_null(cell.load_ms);
    json["asset_bytes"] = or_null(cell.asset_bytes);
    if (cell.runtime_force_n) {
        json["runtime_force_n"] = *cell.runtime_force_n;
        json["runtime_disagreement"] = cell.runtime_disagreement();
    }
    return json;
}

std::string to_cache(const CellResult& cell) {
    return Json{{"converged", cell.converged},
                {"applicable", cell.applicable},
                {"fitted", cell.fitted},
                {"problem", cell.problem},
                {"tets", cell.tetrahedra},
                {"force_n", cell.force_n},
                {"reference_force_n", cell.reference_force_n},
                {"displacement_error", cell.displacement_error},
                {"runtime_force_n", or_null(cell.runtime_force_n)}}
        .dump();
}

bool from_cache(const std::string& text, CellResult& cell) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object() || !json.contains("runtime_force_n")) return false;
    cell.converged = json.at("converged").get<bool>();
    cell.applicable = json.at("applicable").get<bool>();
    cell.fitted = json.at("fitted").get<bool>();
    cell.problem = json.at("problem").get<std::string>();
    cell.tetrahedra = json.at("tets").get<std::uint64_t>();
    cell.force_n = json.at("force_n").get<double>();
    cell.reference_force_n = json.at("reference_force_n").get<double>();
    cell.displacement_error = json.at("displacement_error").get<double>();
    cell.force_error = cell.force_n / cell.reference_force_n - 1;
    if (!json.at("runtime_force_n").is_null())
        cell.runtime_force_n = json.at("runtime_force_n").get<double>();
    return true;
}

std::string times_to_cache(const CellResult& cell) {
    Json json{{"load_ms", or_null(cell.load_ms)}, {"asset_bytes", or_null(cell.asset_bytes)}};
    if (cell.step) {
        json["step"] = step_json(*cell.step);
        json["not_ok"] = cell.step->not_ok;
        json["steps"] = cell.step->steps;
    }
    return json.dump();
}

bool times_from_cache(const std::string& text, CellResult& cell) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object() || !json.contains("asset_bytes") || !json.contains("step")) return false;
    cell.load_ms = json.at("load_ms").get<double>();
    cell.asset_bytes = json.at("asset_bytes").get<std::uint64_t>();
    const Json& step = json.at("step");
    cell.step =
        StepTimes{step.at("p50").get<double>(), step.at("p99").get<double>(), step.at("p999").get<double>(),
                  step.at("max").get<double>(), json.at("steps").get<int>(),  json.at("not_ok").get<int>()};
    return true;
}

}  // namespace knead::tools
