// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/html_report.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "common/error.h"

namespace knead::tools {
namespace {

using nlohmann::json;

constexpr int kDigits = 6;
constexpr int kModulusDigits = 4;

/// The double nearest to `value` written with so many significant digits: its shortest text is no longer.
double rounded(double value, int digits) {
    char text[32];
    const auto end =
        std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1);
    double result = value;
    std::from_chars(text, end.ptr, result);
    return result;
}

void round_fractions(json& value, int digits) {
    if (value.is_number_float()) {
        const double number = rounded(value.get<double>(), digits);
        // Whole numbers lose their ".0", which the page does not need.
        if (number == static_cast<double>(static_cast<std::int32_t>(std::clamp(number, -1e9, 1e9))))
            value = static_cast<std::int32_t>(number);
        else
            value = number;
    } else if (value.is_structured()) {
        for (json& element : value)
            round_fractions(element, digits);
    }
}

/// The members of one result by column name; members of a member as "outer.inner".
std::map<std::string, json> flattened(const json& result) {
    std::map<std::string, json> members;
    for (const auto& [name, value] : result.items()) {
        if (!value.is_object()) {
            members[name] = value;
            continue;
        }
        for (const auto& [inner, inner_value] : value.items())
            members[name + '.' + inner] = inner_value;
    }
    return members;
}

/// Can the page find the members again from flattened names?
bool fits_a_table(const json& results) {
    const auto plain = [](const json& object) {
        return object.is_object() &&
               std::all_of(object.items().begin(), object.items().end(), [](const auto& item) {
                   return item.key().find('.') == std::string::npos && !item.value().is_null();
               });
    };
    return results.is_array() && std::all_of(results.begin(), results.end(), [&](const json& result) {
               return result.is_object() && std::all_of(result.begin(), result.end(), [&](const json& value) {
                          return !value.is_object() || (plain(value) && !value.empty());
                      });
           });
}

json as_table(const json& results) {
    std::vector<std::map<std::string, json>> flat;
    std::set<std::string> names;
    for (const json& result : results) {
        flat.push_back(flattened(result));
        for (const auto& [name, value] : flat.back())
            names.insert(name);
    }
    json rows = json::array();
    for (auto& members : flat) {
        json row = json::array();
        for (const std::string& name : names)
            row.push_back(members.count(name) ? std::move(members[name]) : json());
        rows.push_back(std::move(row));
    }
    return {{"columns", names}, {"rows", std::move(rows)}};
}

/// `values` as indices into its distinct values, in order of appearance, where that is shorter.
json with_palette(json values) {
    std::map<double, std::size_t> places;
    json palette = json::array(), index = json::array();
    for (const json& value : values) {
        if (!value.is_number()) return values;
        const auto [place, is_new] = places.try_emplace(value.get<double>(), palette.size());
        if (is_new) palette.push_back(value);
        index.push_back(place->second);
    }
    if (palette.size() * 2 > values.size()) return values;
    return {{"palette", std::move(palette)}, {"index", std::move(index)}};
}

/// Values that several states may share, each once.
class Pool {
  public:
    /// The index of a value equal to `value`.
    std::size_t place_of(json value) {
        const auto [place, is_new] = places_.try_emplace(value.dump(), values_.size());
        if (is_new) values_.push_back(std::move(value));
        return place->second;
    }
    [[nodiscard]] json values() && { return std::move(values_); }

  private:
    std::map<std::string, std::size_t> places_;
    json values_ = json::array();
};

struct Pools {
    Pool meshes;
    Pool moduli;
};

void shorten_state(json& state, Pools& pools) {
    if (!state.is_object()) return;
    state.erase("bin");
    state.erase("cluster");
    if (state.contains("nodes_m") && state.contains("tetrahedra")) {
        state["mesh"] =
            pools.meshes.place_of({{"nodes_m", state["nodes_m"]}, {"tetrahedra", state["tetrahedra"]}});
        state.erase("nodes_m");
        state.erase("tetrahedra");
    }
    if (json* moduli = state.contains("youngs_modulus_pa") ? &state["youngs_modulus_pa"] : nullptr;
        moduli != nullptr && moduli->is_array()) {
        round_fractions(*moduli, kModulusDigits);
        state["modulus"] = pools.moduli.place_of(with_palette(std::move(*moduli)));
        state.erase("youngs_modulus_pa");
    }
}

/// JSON that may stand in a script element: every `<` is inside a string there, where \u003c means the same.
std::string script_safe(const json& data) {
    std::string safe;
    for (const char c : data.dump(-1, ' ', true, json::error_handler_t::replace)) {
        if (c == '<')
            safe += "\\u003c";
        else
            safe += c;
    }
    return safe;
}

}  // namespace

json page_data(const json& evaluation) {
    json data = evaluation;
    round_fractions(data, kDigits);
    if (!data.is_object() || !data.contains("scenes") || !data["scenes"].is_array()) return data;
    Pools pools;
    for (json& scene : data["scenes"]) {
        if (!scene.is_object()) continue;
        if (scene.contains("results") && fits_a_table(scene["results"]))
            scene["results"] = as_table(scene["results"]);
        if (scene.contains("states") && scene["states"].is_array())
            for (json& state : scene["states"])
                shorten_state(state, pools);
    }
    data["meshes"] = std::move(pools.meshes).values();
    data["moduli"] = std::move(pools.moduli).values();
    return data;
}

std::string html_report(const json& evaluation, const std::string& template_text) {
    const std::string_view placeholder = kReportPlaceholder;
    const std::size_t place = template_text.find(placeholder);
    if (place == std::string::npos || template_text.find(placeholder, place + 1) != std::string::npos)
        fail_input("the template of the report must have " + std::string(placeholder) +
                   " exactly once and has it " + (place == std::string::npos ? "nowhere" : "more than once"));
    return template_text.substr(0, place) + script_safe(page_data(evaluation)) +
           template_text.substr(place + placeholder.size());
}

std::filesystem::path html_template_path(const std::filesystem::path& program) {
    return (program.parent_path().parent_path() / "share" / "knead" / "report.html").lexically_normal();
}

}  // namespace knead::tools
