// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>

#include "common/progress.h"
#include "common/run_tool.h"
#include "knead/asset_gate.h"
#include "knead/build.h"
#include "knead/build_report.h"
#include "knead/formats/write/write.h"
#include "knead/options.h"
#include "quality/report_text.h"

namespace {

using namespace knead;
using namespace knead::tools;

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
    std::ifstream file(asset.file, std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(file), {});
    if (!file) throw ToolError(ExitCode::bad_input, asset.file.string() + ": cannot be read");
    value_or_throw(write_text_file(target, bytes));  // flushed, then renamed: the old asset or the new one
}

/// Looks at what was made and says what its maker should know. What the tools have said is not said again.
std::vector<GatedAsset> gate(const ToolContext& context, const BuildOptionsGiven& options, const Scene& scene,
                             const Plan& plan, const BuildResult& result) {
    const auto was_made = [&](const PlannedAsset& asset) {
        return std::any_of(result.outcomes.begin(), result.outcomes.end(), [&](const StageOutcome& outcome) {
            return outcome.made && outcome.stage->output == asset.file;
        });
    };
    WhenToCheck check = WhenToCheck::automatic;
    if (options.check) check = WhenToCheck::always;
    if (options.no_check) check = WhenToCheck::never;
    const bool everything = options.strict || options.check;
    std::vector<GatedAsset> gated = gate_assets(
        scene, plan, check, [&](const PlannedAsset& asset) { return everything || was_made(asset); });
    for (const GatedAsset& asset : gated) {
        const std::string name = asset.asset->file.filename().string();
        context.tell(summary(name, asset));
        const std::size_t told = was_made(*asset.asset) ? asset.report.findings.size() : 0;
        for (std::size_t k = told; k < asset.findings.size(); ++k) {
            const std::string text = name + ": " + to_text(asset.findings[k]);
            if (asset.findings[k].warning)
                context.warn(text);
            else if (asset.findings[k].id == "level-unchecked")
                context.tell(text);
            else
                context.detail(text);
        }
    }
    return gated;
}

void require_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directory(folder, error);  // its parent must exist: a typing error makes no tree
    if (!std::filesystem::is_directory(folder))
        throw ToolError(ExitCode::cannot_write, folder.string() + ": cannot create this folder" +
                                                    (error ? ": " + error.message() : std::string()));
}

void refuse_warnings(const ToolContext& context, const BuildResult& result,
                     const std::vector<GatedAsset>& gated) {
    std::size_t warnings = 0;
    for (const GatedAsset& asset : gated)
        warnings += asset.warning_count();
    if (warnings == 0) return;
    context.write_report(build_report(result, gated));
    throw ToolError(ExitCode::answer_is_no,
                    fmt::format("{} {}, with --strict", warnings, warnings == 1 ? "warning" : "warnings"));
}

ExitCode run(ToolContext& context, const BuildOptionsGiven& options) {
    const Scene scene = read_scene(options.scene);
    const Plan plan = plan_build(scene, options.levels, options.folder);
    if (!options.asset.empty() && plan.assets.size() != 1)
        fail_usage(fmt::format("--asset needs exactly one level, and this build has {}: add --level NAME",
                               plan.assets.size()));
    if (options.dry_run) {
        for (const Stage& stage : plan.stages)
            std::cout << command_line(stage) << '\n';
        return ExitCode::done;
    }
    require_folder(options.folder);
    if (!options.asset.empty()) require_writable_folder(options.asset);

    Progress progress(!context.quiet);
    const BuildResult result =
        run_build(plan, options.folder, {context.threads, options.force, context.verbose},
                  listener_for(context, progress, plan.stages.size()));
    const std::vector<GatedAsset> gated = gate(context, options, scene, plan, result);
    if (options.strict) refuse_warnings(context, result, gated);
    if (!options.asset.empty()) copy_asset(plan.assets.front(), options.asset);

    for (const auto& source : result.sources)
        context.add_input(source);
    context.set_output(options.asset.empty() ? plan.assets.front().file : options.asset);
    context.write_report(build_report(result, gated));
    for (const PlannedAsset& asset : plan.assets)
        std::cout << asset.file.string() << '\n';
    return ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
    BuildOptionsGiven options;
    ToolInfo info;
    info.name = "knead";
    info.purpose = "bake heterogeneous soft objects for haptic interaction, from one scene file.";
    info.example = "knead build examples/steak/steak.toml -o build/steak";
    info.uses_threads = true;
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare_options(app, options); },
        [&](ToolContext& context) { return run(context, options); });
}
