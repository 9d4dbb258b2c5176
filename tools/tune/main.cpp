// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <iostream>

#include "common/input.h"
#include "common/run_tool.h"
#include "common/stopwatch.h"
#include "knead/formats/hash.h"
#include "knead/formats/write/write.h"
#include "tune/level_writer.h"
#include "tune/options.h"
#include "tune/report.h"

namespace knead::tools {
namespace {

/// The scene with what was found, and the object beside it where no key of a level makes it.
void write_scene(ToolContext& context, const TunedScene& scene, const TuneResult& result,
                 const TuneOptions& options) {
    const TuneCandidate& found = result.candidates[result.outcome.found->candidate];
    const std::filesystem::path object_file =
        options.write_scene.parent_path() / (options.write_scene.stem().string() + ".tuned.hdf");
    const WrittenLevel level = level_for(scene, found.mesh, found.recipe, object_file.filename().string());
    if (level.needs_object) {
        const auto made = scene.make(found.mesh, found.recipe, scene.own_seed());
        Provenance provenance = context.provenance(
            {"--tets", fmt::format("{}", made->mesh->level.mesh.tetrahedra.size()), "--recipe",
             found.recipe.text(), "--seed", fmt::format("{}", scene.own_seed())});
        provenance.inputs = {{"scene", value_or_throw(sha256_of_file(options.scenes.front()))}};
        value_or_throw(write_material(object_file, {made->mesh->level.mesh, made->material}, provenance));
    }
    const std::string text = read_input_bytes(context, options.scenes.front()).value;
    value_or_throw(write_text_file(options.write_scene, scene_with_level(text, options.scenes.front(),
                                                                         level.toml, options.write_scene)));
    context.tell(
        fmt::format("knead build {} -o FOLDER --level {}", options.write_scene.string(), level.name));
}

TuneResult tune_scene(ToolContext& context, const TuneOptions& options, const TuneRequest& request,
                      const std::filesystem::path& file, const ResultCache& cache) {
    const FileReader read = [&](const std::filesystem::path& input) {
        return read_input_bytes(context, input).value;
    };
    context.add_input(file);
    const TunedScene scene(file, load_names(request), request.levels, read, cache);
    TuneResult result = tune(scene, request, [&](std::string_view text) {
        context.detail(fmt::format("{}: {}", scene.scene().name, text));
    });
    std::cout << text_report(result, context.verbose) << std::endl;  // each scene as soon as it is done
    if (result.outcome.found && !options.write_scene.empty()) write_scene(context, scene, result, options);
    return result;
}

ExitCode run(ToolContext& context, const TuneOptions& options, const std::vector<std::string>& arguments) {
    const Stopwatch watch;
    const TuneRequest request = request_of(options);
    if (!options.json.empty()) context.set_output(options.json);
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, context.threads);
    const ResultCache cache = open_cache(options.cache);
    const baseline::Machine machine = baseline::describe_machine();
    std::vector<TuneResult> results;
    for (const auto& file : options.scenes)
        results.push_back(tune_scene(context, options, request, file, cache));
    std::size_t found = 0;
    std::string summary;
    for (const TuneResult& result : results) {
        found += result.outcome.found ? 1 : 0;
        summary += verdict(result) + "\n";
    }
    if (results.size() > 1) std::cout << summary;
    const auto json = json_report(results, machine, fmt::format("knead-tune {}", fmt::join(arguments, " ")));
    if (!options.json.empty()) value_or_throw(write_text_file(options.json, json.dump() + "\n"));
    const nlohmann::ordered_json report{
        {"scenes", results.size()}, {"found", found}, {"seconds", watch.seconds()}};
    context.write_report(report.dump(2) + "\n");
    return found == results.size() ? ExitCode::done : ExitCode::answer_is_no;
}

}  // namespace
}  // namespace knead::tools

int main(int argc, char** argv) {
    using namespace knead::tools;
    TuneOptions options;
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const ToolInfo info{
        .name = "knead-tune",
        .purpose =
            "find the fastest level of a scene whose forces stay within an error, and prove it on seeds "
            "and loads that it was not chosen on.",
        .example =
            "knead-tune steak.toml --within 10% --budget 200us --on press,pads --write-scene tuned.toml",
        .libraries = {},
        .uses_threads = true};
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare_options(app, options); },
        [&](ToolContext& context) { return run(context, options, arguments); });
}
