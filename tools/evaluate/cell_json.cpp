// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/cell_json.h"

#include <stdexcept>

#include "evaluate/kept_json.h"
#include "evaluate/whole_number.h"

namespace knead::tools {
namespace {

using Json = nlohmann::ordered_json;

Json step_json(const StepTimes& step) {
    return {{"p50", step.p50_us}, {"p99", step.p99_us}, {"p999", step.p999_us}, {"max", step.max_us}};
}

Json kept_step(const StepTimes& step) {
    Json json = step_json(step);
    json["steps"] = step.steps;
    json["not_ok"] = step.not_ok;
    return json;
}

StepTimes step_of(const Json& json) {
    return {json.at("p50").get<double>(),        json.at("p99").get<double>(),
            json.at("p999").get<double>(),       json.at("max").get<double>(),
            whole_number<int>(json.at("steps")), whole_number<int>(json.at("not_ok"))};
}

template <class T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

void read_cell(const Json& json, CellResult& cell) {
    cell.converged = json.at("converged").get<bool>();
    cell.applicable = json.at("applicable").get<bool>();
    cell.fitted = json.at("fitted").get<bool>();
    cell.problem = json.at("problem").get<std::string>();
    cell.tetrahedra = whole_number<std::uint64_t>(json.at("tets"));
    cell.force_n = json.at("force_n").get<double>();
    cell.reference_force_n = json.at("reference_force_n").get<double>();
    cell.displacement_error = json.at("displacement_error").get<double>();
    cell.force_error = cell.force_n / cell.reference_force_n - 1;
    if (!json.at("runtime_force_n").is_null())
        cell.runtime_force_n = json.at("runtime_force_n").get<double>();
}

void read_times(const Json& json, CellResult& cell) {
    cell.load_ms = json.at("load_ms").get<double>();
    cell.asset_bytes = whole_number<std::uint64_t>(json.at("asset_bytes"));
    cell.step = step_of(json.at("step"));
}

void read_speed(const Json& json, SpeedPair& pair) {
    pair = {step_of(json.at("runtime")), step_of(json.at("baseline"))};
}

void read_curve(const Json& json, ForceCurve& curve) {
    curve = {json.at("time_s").get<std::vector<double>>(), json.at("force_n").get<std::vector<double>>()};
    if (curve.time_s.size() != curve.force_n.size()) throw std::length_error("a force for each time");
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
    return read_kept(text, read_cell, cell);
}

std::string times_to_cache(const CellResult& cell) {
    Json json{{"load_ms", or_null(cell.load_ms)}, {"asset_bytes", or_null(cell.asset_bytes)}};
    if (cell.step) json["step"] = kept_step(*cell.step);
    return json.dump();
}

bool times_from_cache(const std::string& text, CellResult& cell) {
    return read_kept(text, read_times, cell);
}

nlohmann::ordered_json to_json(const SpeedResult& speed) {
    return {{"method", speed.method},
            {"bins", speed.bins},
            {"clusters", speed.clusters},
            {"tets", speed.tetrahedra},
            {"runtime_us", step_json(speed.times.runtime)},
            {"baseline_us", step_json(speed.times.baseline)}};
}

std::string speed_to_cache(const SpeedPair& pair) {
    return Json{{"runtime", kept_step(pair.runtime)}, {"baseline", kept_step(pair.baseline)}}.dump();
}

bool speed_from_cache(const std::string& text, SpeedPair& pair) {
    return read_kept(text, read_speed, pair);
}

std::string curve_to_cache(const ForceCurve& curve) {
    return Json{{"time_s", curve.time_s}, {"force_n", curve.force_n}}.dump();
}

bool curve_from_cache(const std::string& text, ForceCurve& curve) {
    return read_kept(text, read_curve, curve);
}

}  // namespace knead::tools
