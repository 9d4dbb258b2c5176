// SPDX-License-Identifier: GPL-3.0-or-later
#include "knead/build.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <system_error>

#include "common/error.h"
#include "knead/build_state.h"
#include "knead/child_process.h"

namespace knead::tools {
namespace {

/// Exit codes of a tool mean the same for the driver, but for bad usage: the command line came from the
/// scene. A signal or an unknown code is a bug.
ExitCode exit_code_of(int status) {
    if (status == static_cast<int>(ExitCode::bad_usage)) return ExitCode::bad_input;
    for (const ExitCode code : {ExitCode::bad_input, ExitCode::cannot_write, ExitCode::no_valid_result})
        if (status == static_cast<int>(code)) return code;
    return ExitCode::bug;
}

struct RemovedAtTheEnd {
    std::filesystem::path file;
    explicit RemovedAtTheEnd(std::filesystem::path name) : file(std::move(name)) {}
    RemovedAtTheEnd(const RemovedAtTheEnd&) = delete;
    RemovedAtTheEnd& operator=(const RemovedAtTheEnd&) = delete;
    ~RemovedAtTheEnd() {
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
    }
};

/// Runs one stage. @return the files that it read
std::vector<std::filesystem::path> run_stage(const Stage& stage, const std::filesystem::path& program,
                                             const BuildOptions& options, const BuildListener& listener) {
    // A name of this process: another build of the same folder has its own.
    const auto depfile =
        stage.output.parent_path() / fmt::format(".{}.{}.d", stage.output.filename().string(), getpid());
    const RemovedAtTheEnd cleaner{depfile};
    std::vector<std::string> arguments = stage.arguments;
    arguments.insert(arguments.end(), {"--depfile", depfile.string()});
    if (stage.threaded) arguments.insert(arguments.end(), {"--threads", std::to_string(options.threads)});
    if (options.verbose)
        arguments.emplace_back("--verbose");
    else
        arguments.emplace_back("--quiet");
    const int status = run_child(program, arguments, listener.stderr_text);
    if (status != 0)
        throw ToolError(exit_code_of(status), fmt::format("{} failed with exit code {} while making {}",
                                                          stage.tool, status, stage.output.string()));
    return read_depfile(depfile);
}

void collect_sources(const Plan& plan, const std::vector<std::filesystem::path>& files, BuildResult& result) {
    for (const auto& file : files) {
        const bool made_here = std::any_of(plan.stages.begin(), plan.stages.end(),
                                           [&](const Stage& stage) { return stage.output == file; });
        if (!made_here &&
            std::find(result.sources.begin(), result.sources.end(), file) == result.sources.end())
            result.sources.push_back(file);
    }
}

}  // namespace

BuildResult run_build(const Plan& plan, const std::filesystem::path& folder, const BuildOptions& options,
                      const BuildListener& listener) {
    BuildState state = BuildState::load(folder);
    BuildResult result;
    for (std::size_t i = 0; i < plan.stages.size(); ++i) {
        const Stage& stage = plan.stages[i];
        const auto program = find_tool(stage.tool);
        StageOutcome outcome{&stage, options.force || !state.up_to_date(stage, program), 0};
        if (outcome.made) {
            listener.begins(stage, i);
            const auto start = std::chrono::steady_clock::now();
            state.record(stage, program, run_stage(stage, program, options, listener));
            outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            state.save();
        }
        collect_sources(plan, state.dependencies(stage), result);
        listener.ended(outcome);
        result.outcomes.push_back(outcome);
    }
    return result;
}

}  // namespace knead::tools
