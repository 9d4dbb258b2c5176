// SPDX-License-Identifier: GPL-3.0-or-later
#include "tune/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "common/run_tool.h"
#include "material/csv.h"
#include "scene/toml_table.h"
#include "tune/tune_loads.h"

namespace knead::tools {
namespace {

double within_of(const std::string& typed) {
    const double share = share_of(typed).value_or(-1);
    if (!(share > 0 && share <= 1))
        fail_usage(fmt::format("--within: \"{}\" is not a share above 0 and up to 100 %, such as 10% or 0.1",
                               typed));
    return share;
}

void check_method(const std::string& name) {
    const std::vector<std::string>& known = tunable_methods();
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    if (name == name_of(MethodKind::kmod09))
        fail_usage("--methods: the runtime cannot run kmod09 (a full tensor for each tetrahedron)");
    const std::string near = nearest_word(name, known);
    fail_usage(fmt::format("--methods: unknown method \"{}\"{} (known: {})", name,
                           near.empty() ? "" : "; did you mean " + near + "?", fmt::join(known, ", ")));
}

std::optional<std::vector<std::string>> held_out_of(const TuneOptions& options,
                                                    const std::vector<std::string>& on) {
    if (options.held_out.empty()) return std::nullopt;
    if (options.held_out == std::vector<std::string>{"none"}) return std::vector<std::string>{};
    std::vector<std::string> held_out = loads_of(options.held_out, "--held-out");
    for (const std::string& load : held_out)
        if (std::find(on.begin(), on.end(), load) != on.end())
            fail_usage(fmt::format("--held-out: {} is chosen on (--on), so it is not held out", load));
    return held_out;
}

}  // namespace

void declare_options(CLI::App& app, TuneOptions& options) {
    app.add_option("SCENE", options.scenes, "scene files (TOML)")->required()->group("Inputs");
    app.add_option("--within", options.within, "largest error of a force: 10% or 0.1")
        ->capture_default_str()
        ->type_name("SHARE");
    app.add_option("--budget", options.budget, "largest time of a step on this machine: 200us or 0.2ms")
        ->required()
        ->type_name("TIME");
    app.add_option("--budget-of", options.budget_of, "what must keep to it: p99 (99 % of the steps) or p50")
        ->capture_default_str()
        ->check(CLI::IsMember({"p50", "p99"}))
        ->type_name("WHAT");
    app.add_option("--on", options.on,
                   fmt::format("loads to choose on: {}; {}; scene, scene:TOOL", group_help(),
                               fmt::join(named_loads(), ", ")))
        ->required()
        ->delimiter(',')
        ->type_name("LOAD,...");
    app.add_option("--held-out", options.held_out,
                   "loads of the claim that are not chosen on, or none [like those of --on: a press of 15 %, "
                   "pads at the opposite places]")
        ->delimiter(',')
        ->type_name("LOAD,...");
    app.add_option("--methods", options.methods,
                   fmt::format("what makes elasticities, all of: {}", fmt::join(tunable_methods(), ", ")))
        ->delimiter(',')
        ->type_name("NAME,...");
    declare_paper_method(app, options.bins, options.clusters);
    app.add_option("--levels", options.levels,
                   "coarse meshes: names of the scene's levels or numbers of tetrahedra [the scene's and a "
                   "range of generated ones]")
        ->delimiter(',')
        ->type_name("LEVEL,...");
    app.add_option("--seeds", options.seeds, "seeds to choose on, from the scene's own")
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--verify-seeds", options.verify_seeds, "fresh seeds to verify a choice on")
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--steps", options.steps, "steps of the runtime to time")
        ->capture_default_str()
        ->check(CLI::Range(10, 10000000))
        ->type_name("N");
    app.add_option("--repeats", options.repeats, "how often they are timed; the lowest counts")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000))
        ->type_name("N");
    app.add_option("--json", options.json, "also write everything as JSON")->type_name("FILE");
    app.add_option("--write-scene", options.write_scene,
                   "also write the scene with the level that was found, ready for knead build")
        ->type_name("FILE");
    declare_options(app, options.cache);
}

double budget_us_of(const std::string& text) {
    std::string number = text;
    double factor = 1;
    const auto ends_with = [&](const char* unit) {
        const std::string end(unit);
        return number.size() > end.size() && number.compare(number.size() - end.size(), end.size(), end) == 0;
    };
    if (ends_with("us")) {
        number.resize(number.size() - 2);
    } else if (ends_with("ms")) {
        number.resize(number.size() - 2);
        factor = 1000;
    }
    while (!number.empty() && number.back() == ' ')
        number.pop_back();
    const std::optional<double> value = parse_number(number);
    if (!value || !std::isfinite(*value) || !(*value > 0))
        fail_usage(fmt::format("--budget: \"{}\" is not a time above 0, such as 200us or 0.2ms", text));
    return *value * factor;
}

TuneRequest request_of(const TuneOptions& options) {
    TuneRequest request;
    request.within = within_of(options.within);
    request.budget_us = budget_us_of(options.budget);
    request.budget_is_p50 = options.budget_of == "p50";
    request.on = loads_of(options.on, "--on");
    request.held_out = held_out_of(options, request.on);
    request.choice = {options.methods.empty() ? tunable_methods() : options.methods, options.bins,
                      options.clusters};
    for (const std::string& method : request.choice.methods)
        check_method(method);
    if (options.seeds == 0) fail_usage("--seeds 0: nothing could be chosen; at least one is needed");
    if (options.verify_seeds == 0) fail_usage("--verify-seeds 0: nothing would be verified; at least one");
    request.levels = options.levels;
    request.choosing_seeds = options.seeds;
    request.fresh_seeds = options.verify_seeds;
    request.steps = options.steps;
    request.repeats = options.repeats;
    if (!options.write_scene.empty() && options.scenes.size() != 1)
        fail_usage(fmt::format("--write-scene needs exactly one scene; there are {}", options.scenes.size()));
    for (const auto& file : {options.json, options.write_scene})
        if (!file.empty()) require_writable_folder(file);
    return request;
}

}  // namespace knead::tools
