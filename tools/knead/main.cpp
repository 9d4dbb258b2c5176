// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "common/progress.h"
#include "common/run_tool.h"
#include "knead/build.h"
#include "knead/formats/write/write.h"

namespace {

using namespace knead;
using namespace knead::tools;

struct Options {
    std::filesystem::path scene;
    std::filesystem::path folder;
    std::filesystem::path asset;
    std::vector<std::string> levels;
    bool force = false;
    bool dry_run = false;
};

void declare(CLI::App& app, Options& options) {
    app.require_subcommand(1);
    CLI::App* build = app.add_subcommand("build", "run the tools that a scene needs, from mesh to assets");
    build->fallthrough();
    build->add_option("SCENE", options.scene, "scene file (TOML)")->required();
    build->add_option("-o,--output", options.folder, "folder for everything that is made; created if missing")
        ->required();
    build->add_option("-l,--level", options.levels, "only this level; may be given again [all]")
        ->type_name("NAME");
    build->add_option("--asset", options.asset, "also put the asset here (with exactly one level)")
        ->type_name("FILE");
    build->add_flag("--force", options.force, "run every tool, also where its output is up to date");
    build->add_flag("--dry-run", options.dry_run, "print the commands of the tools and run none");
}

void print_commands(const Plan& plan) {
    for (const Stage& stage : plan.stages) {
        std::cout << stage.tool;
        for (const std::string& argument : stage.arguments) {
            const bool plain =
                argument.find_first_of(" '\"$*?()&;<>|\\") == std::string::npos && !argument.empty();
            std::cout << ' ' << (plain ? argument : "'" + argument + "'");
        }
        std::cout << '\n';
    }
}

BuildListener listener_for(const ToolContext& context, Progress& progress, std::size_t total) {
    BuildListener listener;
    listener.begins = [&progress, total](const Stage& stage, std::size_t index) {
        progress.show(index, total, stage.tool + " " + stage.output.filename().string());
    };
    listener.ended = [&context, &progress](const StageOutcome& outcome) {
        progress.clear();
        const std::string name = outcome.stage->output.filename().string();
        if (outcome.made)
            context.tell(
                fmt::format("{:<15} made {} in {:.2f} s", outcome.stage->tool, name, outcome.seconds));
        else
            context.tell(fmt::format("{:<15} kept {}: up to date", outcome.stage->tool, name));
    };
    listener.stderr_text = [&progress](std::string_view text) {
        progress.clear();
        std::cerr << text;
    };
    return listener;
}

void copy_asset(const PlannedAsset& asset, const std::filesystem::path& target) {
    auto temporary = target;
    temporary += ".part";
    std::error_code error;
    std::filesystem::copy_file(asset.file, temporary, std::filesystem::copy_options::overwrite_existing,
                               error);
    if (!error) std::filesystem::rename(temporary, target, error);
    if (!error) return;
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw ToolError(ExitCode::cannot_write, target.string() + ": " + error.message());
}

std::string report(const Plan& plan, const BuildResult& result) {
    nlohmann::ordered_json json;
    json["schema"] = "knead-build-report/1";
    for (const StageOutcome& outcome : result.outcomes)
        json["stages"].push_back({{"tool", outcome.stage->tool},
                                  {"output", outcome.stage->output.string()},
                                  {"made", outcome.made},
                                  {"seconds", outcome.seconds}});
    for (const PlannedAsset& asset : plan.assets)
        json["assets"].push_back({{"level", asset.level}, {"file", asset.file.string()}});
    return json.dump(2) + "\n";
}

void require_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directory(folder, error);  // its parent must exist: a typing error makes no tree
    if (!std::filesystem::is_directory(folder))
        throw ToolError(ExitCode::cannot_write, folder.string() + ": cannot create this folder" +
                                                    (error ? ": " + error.message() : std::string()));
}

ExitCode run(ToolContext& context, const Options& options) {
    const Scene scene = read_scene(options.scene);
    const Plan plan = plan_build(scene, options.levels, options.folder);
    if (!options.asset.empty() && plan.assets.size() != 1)
        fail_usage(fmt::format("--asset needs exactly one level, and this build has {}: add --level NAME",
                               plan.assets.size()));
    if (options.dry_run) {
        print_commands(plan);
        return ExitCode::done;
    }
    require_folder(options.folder);
    if (!options.asset.empty()) require_writable_folder(options.asset);

    Progress progress(!context.quiet);
    const BuildResult result =
        run_build(plan, options.folder, {context.threads, options.force, context.verbose},
                  listener_for(context, progress, plan.stages.size()));
    if (!options.asset.empty()) copy_asset(plan.assets.front(), options.asset);

    for (const auto& source : result.sources)
        context.add_input(source);
    context.set_output(options.asset.empty() ? plan.assets.front().file : options.asset);
    context.write_report(report(plan, result));
    for (const PlannedAsset& asset : plan.assets)
        std::cout << asset.file.string() << '\n';
    return ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    ToolInfo info;
    info.name = "knead";
    info.purpose = "bake heterogeneous soft objects for haptic interaction, from one scene file.";
    info.example = "knead build examples/steak/steak.toml -o build/steak";
    info.uses_threads = true;
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare(app, options); },
        [&](ToolContext& context) { return run(context, options); });
}
