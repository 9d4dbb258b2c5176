// SPDX-License-Identifier: GPL-3.0-or-later
#include "tune/tune_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/error.h"
#include "scene/toml_table.h"

namespace knead::tools {
namespace {

const std::vector<std::pair<std::string, std::vector<std::string>>>& groups() {
    static const std::vector<std::pair<std::string, std::vector<std::string>>> all{
        {"press", {"press10", "press20"}},
        {"pads", {"pad4", "pad3", "tip2", "side"}},
        {"all", named_loads()}};
    return all;
}

struct Sibling {
    const char* name;
    const char* of;
};
constexpr Sibling kSiblings[] = {{"press15", "press10"},
                                 {"pad4-opposite", "pad4"},
                                 {"pad3-opposite", "pad3"},
                                 {"tip2-opposite", "tip2"},
                                 {"side-opposite", "side"}};
/// A press between the two that have names.
constexpr double kDeeper = 1.5;

bool has(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_scenes(const std::string& name) {
    return name == "scene" || name.rfind("scene:", 0) == 0;
}

[[noreturn]] void fail_unknown(const std::string& name, const char* option) {
    std::vector<std::string> known;
    for (const auto& [group, loads] : groups())
        known.push_back(group);
    known.insert(known.end(), named_loads().begin(), named_loads().end());
    for (const Sibling& sibling : kSiblings)
        known.emplace_back(sibling.name);
    known.emplace_back("scene");
    const std::string near = nearest_word(name, known);
    fail_usage(fmt::format("{}: unknown load \"{}\"{} (known: {})", option, name,
                           near.empty() ? "" : "; did you mean " + near + "?", fmt::join(known, ", ")));
}

/// To the other end of an axis of the object.
void mirror(Load& load, const Box& object, std::size_t axis) {
    const double sum_m = object.low_m[axis] + object.high_m[axis];
    const double low_m = load.region.within.low_m[axis];
    load.region.within.low_m[axis] = sum_m - load.region.within.high_m[axis];
    load.region.within.high_m[axis] = sum_m - low_m;
    for (Point* vector : {&load.region.facing, &load.motion.translation_m, &load.felt_translation})
        (*vector)[axis] = -(*vector)[axis];
}

}  // namespace

std::vector<std::string> loads_of(const std::vector<std::string>& names, const char* option) {
    std::vector<std::string> wanted, scenes;
    for (const std::string& name : names) {
        const auto group = std::find_if(groups().begin(), groups().end(),
                                        [&](const auto& candidate) { return candidate.first == name; });
        if (group != groups().end())
            wanted.insert(wanted.end(), group->second.begin(), group->second.end());
        else if (has(named_loads(), name) || is_sibling(name))
            wanted.push_back(name);
        else if (!is_scenes(name))
            fail_unknown(name, option);
        else if (!has(scenes, name))
            scenes.push_back(name);
    }
    std::vector<std::string> loads;
    for (const std::string& name : named_loads())
        if (has(wanted, name)) loads.push_back(name);
    for (const Sibling& sibling : kSiblings)
        if (has(wanted, sibling.name)) loads.emplace_back(sibling.name);
    loads.insert(loads.end(), scenes.begin(), scenes.end());
    return loads;
}

std::string group_help() {
    std::string text;
    for (const auto& [group, loads] : groups())
        if (group != "all") text += fmt::format("{} ({}), ", group, fmt::join(loads, ", "));
    return text + "all";
}

std::vector<std::string> siblings_of(const std::vector<std::string>& loads) {
    std::vector<std::string> siblings;
    for (const Sibling& sibling : kSiblings) {
        const bool pressed = std::string(sibling.of) == "press10" && has(loads, "press20");
        if ((pressed || has(loads, sibling.of)) && !has(loads, sibling.name))
            siblings.emplace_back(sibling.name);
    }
    return siblings;
}

std::vector<std::string> other_loads(const std::vector<std::string>& loads) {
    std::vector<std::string> others;
    for (const std::string& name : named_loads())
        if (!has(loads, name)) others.push_back(name);
    return others;
}

bool is_sibling(const std::string& name) {
    return std::any_of(std::begin(kSiblings), std::end(kSiblings),
                       [&](const Sibling& sibling) { return name == sibling.name; });
}

Load sibling_load(const std::string& name, const Box& object) {
    const Sibling& sibling = *std::find_if(std::begin(kSiblings), std::end(kSiblings),
                                           [&](const Sibling& candidate) { return name == candidate.name; });
    Load load = named_load(sibling.of, object);
    load.name = name;
    if (std::string(sibling.of) == "press10") {
        for (double& x : load.motion.translation_m)
            x *= kDeeper;
        return load;
    }
    mirror(load, object, 0);
    return load;
}

std::vector<std::string> hardest_first(std::vector<std::string> loads) {
    static const std::vector<std::string> order{
        "tip2",          "tip2-opposite", "side",     "pad3",  "side-opposite", "pad3-opposite", "pad4",
        "pad4-opposite", "twist",         "combined", "shear", "press20",       "press15",       "press10"};
    const auto rank = [&](const std::string& name) {
        return std::find(order.begin(), order.end(), name) - order.begin();
    };
    std::stable_sort(loads.begin(), loads.end(),
                     [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
    return loads;
}

}  // namespace knead::tools
