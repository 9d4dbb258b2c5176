// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/run_tool.h"
#include "evaluate/loads.h"
#include "scene/toml_table.h"

namespace knead::tools {
namespace {

std::size_t index_of(const std::string& name, const std::vector<std::string>& known, const char* what) {
    const auto at = std::find(known.begin(), known.end(), name);
    if (at != known.end()) return static_cast<std::size_t>(at - known.begin());
    const std::string near = nearest_word(name, known);
    fail_usage(fmt::format("unknown {} \"{}\"{} (known: {})", what, name,
                           near.empty() ? "" : "; did you mean " + near + "?", fmt::join(known, ", ")));
}

void check_load(const std::string& name) {
    if (name.rfind("scene:", 0) == 0) return;  // the scene knows its tools
    std::vector<std::string> known = named_loads();
    known.emplace_back("scene");
    (void)index_of(name, known, "load");
}

std::vector<Method> methods_of(const EvaluateOptions& options) {
    std::vector<Method> methods;
    const auto add = [&](const Method& method) {
        if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
    };
    for (const std::string& name : options.methods) {
        const auto kind = static_cast<MethodKind>(index_of(name, method_names(), "method"));
        if (kind == MethodKind::homogenised) {
            add({kind, 1, 1});
        } else if (kind == MethodKind::paper) {
            for (const std::uint32_t bins : options.bins)
                for (const std::uint32_t clusters : options.clusters)
                    add({kind, bins, clusters});
        } else {
            add({kind, 0, 0});
        }
    }
    return methods;
}

}  // namespace

void declare_options(CLI::App& app, EvaluateOptions& options) {
    app.add_option("SCENE", options.scenes, "scene files (TOML)")->group("Inputs");
    app.add_option("--methods", options.methods, fmt::format("methods: {}", fmt::join(method_names(), ", ")))
        ->delimiter(',')
        ->capture_default_str()
        ->type_name("NAME,...");
    declare_paper_method(app, options.bins, options.clusters);
    app.add_option(
           "--levels", options.levels,
           "coarse meshes: names of the scene's levels, \"fine\", or numbers of tetrahedra [the coarse "
           "meshes of the scene]")
        ->delimiter(',')
        ->type_name("LEVEL,...");
    app.add_option(
           "--loads", options.loads,
           fmt::format("loads: {}, scene (its first tool), scene:TOOL", fmt::join(named_loads(), ", ")))
        ->delimiter(',')
        ->capture_default_str()
        ->type_name("NAME,...");
    app.add_option("--seeds", options.seeds, "how many seeds, of the material and of k-means")
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--seed-base", options.seed_base, "the first of them")
        ->capture_default_str()
        ->type_name("S");
    app.add_option("--reference", options.reference,
                   "what errors are against: fine (the scene's fine mesh), finer (each tetrahedron in eight)")
        ->capture_default_str()
        ->check(CLI::IsMember({"fine", "finer"}))
        ->type_name("KIND");
    app.add_option("--steps", options.steps, "steps of the runtime to time; 0: no times")
        ->capture_default_str()
        ->check(CLI::Range(0, 10000000))
        ->type_name("N");
    app.add_flag("--curves", options.curves, "also record the force over time of a slow press (first seed)");
    app.add_flag("--states", options.states,
                 "also put the object's states C1 to C5 and the contents of its asset into the JSON");
    app.add_flag("--beside-paper", options.beside_paper,
                 "also put the paper's published numbers into the JSON");
    app.add_option("--html", options.html, "also write one page that opens offline; has curves and states")
        ->type_name("FILE");
    app.add_option("--json", options.json, "also write everything as JSON")->type_name("FILE");
    app.add_option("--csv", options.csv, "also write one line for each result")->type_name("FILE");
    app.add_option("--fail-above", options.fail_above,
                   "exit with 1 when a force error is above this, or something did not converge")
        ->type_name("SHARE");
    declare_options(app, options.cache);
    auto* paper = app.add_option("--paper", options.paper,
                                 "the paper's evaluation of its scenes (scenario1 to scenario9, steak): "
                                 "tables beside the paper's, into "
                                 "this folder");
    paper->type_name("FOLDER");
    for (const char* other :
         {"--methods", "--bins", "--clusters", "--levels", "--loads", "--reference", "--curves", "--states",
          "--beside-paper", "--html", "--json", "--csv", "--fail-above"})
        paper->excludes(other);
    stability::declare_options(app, options.stability);
}

EvaluationRequest request_of(const EvaluateOptions& options, unsigned threads) {
    if (options.scenes.empty()) fail_usage("SCENE is required (or --stability)");
    for (const std::string& load : options.loads)
        check_load(load);
    if (options.seeds == 0) fail_usage("--seeds 0: nothing would be evaluated; at least one is needed");
    for (const auto& file : {options.json, options.csv, options.html})
        if (!file.empty()) require_writable_folder(file);
    if (!options.paper.empty()) require_writable_folder(options.paper / "paper.json");
    EvaluationRequest request;
    request.scenes = options.scenes;
    request.methods = methods_of(options);
    request.levels = options.levels;
    request.loads = options.loads;
    request.seeds = options.seeds;
    request.seed_base = options.seed_base;
    request.reference = options.reference == "finer" ? ReferenceKind::finer : ReferenceKind::fine;
    request.timed_steps = options.steps;
    request.with_curves = options.curves || !options.html.empty();
    request.with_states = options.states || !options.html.empty();
    request.threads = threads;
    return request;
}

std::optional<double> fail_above_of(const EvaluateOptions& options) {
    if (options.fail_above.empty()) return std::nullopt;
    const std::optional<double> share = share_of(options.fail_above);
    if (!share || !std::isfinite(*share) || *share < 0)
        fail_usage(fmt::format("--fail-above: \"{}\" is not a share such as 10% or 0.1", options.fail_above));
    return share;
}

}  // namespace knead::tools
