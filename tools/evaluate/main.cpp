// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <iostream>

#include "baseline/machine.h"
#include "common/input.h"
#include "common/progress.h"
#include "common/run_tool.h"
#include "common/stopwatch.h"
#include "evaluate/html_report.h"
#include "evaluate/installed_files.h"
#include "evaluate/options.h"
#include "evaluate/paper/files.h"
#include "evaluate/paper/run.h"
#include "evaluate/tables.h"
#include "knead/formats/write/write.h"

namespace knead::tools {
namespace {

std::string minutes(double seconds) {
    const auto whole = static_cast<long>(seconds + 0.5);
    return fmt::format("{}:{:02} left", whole / 60, whole % 60);
}

constexpr const char* kDisagreement = "the runtime and the reference solver differ by more than 0.1 %: ";

std::string today() {
    return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::chrono::system_clock::now()));
}

/// On a terminal, unless the user says otherwise (no-color.org).
bool colours_wanted() {
    const char* const no_colour = std::getenv("NO_COLOR");
    return isatty(STDOUT_FILENO) != 0 && (no_colour == nullptr || *no_colour == '\0');
}

std::string command_line(const std::vector<std::string>& arguments) {
    return fmt::format("knead-evaluate {}", fmt::join(arguments, " "));
}

std::vector<SceneResult> run_evaluation(ToolContext& context, const EvaluateOptions& options) {
    EvaluationRequest request = request_of(options, context.threads);
    const ResultCache cache = open_cache(options.cache);
    Progress progress(!context.quiet);
    const Stopwatch watch;
    EvaluationListener listener;
    listener.progress = [&](std::size_t done, std::size_t total, std::string_view what) {
        const double left_s = watch.seconds() / static_cast<double>(done) * static_cast<double>(total - done);
        progress.show(done, total, fmt::format("{} {}", minutes(left_s), what));
    };
    const FileReader read = [&](const std::filesystem::path& file) {
        return read_input_bytes(context, file).value;
    };
    for (const auto& scene : request.scenes)
        context.add_input(scene);
    const auto& all = options.paper.empty() ? evaluate : evaluate_paper;
    return all(request, cache, read, listener);
}

/// The paper's tables instead of ours.
ExitCode show_paper(ToolContext& context, const EvaluateOptions& options,
                    const std::vector<SceneResult>& scenes, const PaperRun& about) {
    const PaperSummary summary = write_paper(options.paper, scenes, about);
    const std::string wrong = disagreements(scenes);
    if (!wrong.empty()) fail_result(kDisagreement + wrong);
    std::cout << as_text(paper_document(summary, about), colours_wanted());
    if (!summary.rows_are_ok()) context.tell("a reference or homogenised row is not what is expected");
    return summary.rows_are_ok() ? ExitCode::done : ExitCode::answer_is_no;
}

ExitCode run(ToolContext& context, const EvaluateOptions& options,
             const std::vector<std::string>& arguments) {
    const Stopwatch watch;
    const std::optional<double> limit = fail_above_of(options);
    if (!options.json.empty()) context.set_output(options.json);
    const std::string page = options.html.empty() ? std::string() : required_page_template();
    const baseline::Machine machine = baseline::describe_machine();
    if (options.stability.wanted) {
        if (!options.scenes.empty()) fail_usage("--stability has objects of its own and takes no SCENE");
        return stability::run_stability(
            context, options.stability,
            {{{"cpu", machine.cpu}, {"compiler", machine.compiler}, {"os", machine.os}},
             KNEAD_COMMIT,
             command_line(arguments)},
            options.json);
    }
    const std::vector<SceneResult> scenes = run_evaluation(context, options);
    if (!options.paper.empty())
        return show_paper(context, options, scenes,
                          {machine, KNEAD_COMMIT, command_line(arguments), today(), watch.seconds()});
    auto json = json_report(scenes, machine, KNEAD_COMMIT, command_line(arguments));
    if (options.beside_paper) json["paper"] = papers_numbers();
    if (!options.json.empty()) value_or_throw(write_text_file(options.json, json.dump() + "\n"));
    if (!options.html.empty()) value_or_throw(write_text_file(options.html, html_report(json, page)));
    if (!options.csv.empty()) value_or_throw(write_text_file(options.csv, csv_report(scenes)));
    std::size_t cells = 0;
    for (const SceneResult& scene : scenes)
        cells += scene.cells.size();
    const std::size_t above = limit ? count_above(scenes, *limit) : 0;
    nlohmann::ordered_json report{
        {"scenes", scenes.size()}, {"results", cells}, {"seconds", watch.seconds()}};
    if (limit) report["above"] = above;
    context.write_report(report.dump(2) + "\n");
    const std::string wrong = disagreements(scenes);
    if (!wrong.empty()) fail_result(kDisagreement + wrong);
    std::cout << text_report(scenes);
    if (limit && above > 0)
        context.tell(
            fmt::format("{} of {} results are above {:g} % or did not converge", above, cells, 100 * *limit));
    return above > 0 ? ExitCode::answer_is_no : ExitCode::done;
}

}  // namespace
}  // namespace knead::tools

int main(int argc, char** argv) {
    using namespace knead::tools;
    EvaluateOptions options;
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const ToolInfo info{
        .name = "knead-evaluate",
        .purpose =
            "say what each level of a scene costs in error of force and shape, and what it gains in time.",
        .example =
            "knead-evaluate steak.toml --methods paper,voigt --loads press10,scene --seeds 10 --json "
            "steak.json",
        .libraries = {},
        .uses_threads = true};
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare_options(app, options); },
        [&](ToolContext& context) { return run(context, options, arguments); });
}
