// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run_tool.h"

#include <exception>
#include <iostream>
#include <new>
#include <thread>

#include "knead/formats/version.h"
#include "knead/formats/write/write.h"

namespace knead::tools {
namespace {

constexpr const char* kExitStatus =
    "Exit status: 0 done, 1 the answer is no, 2 bad usage, 3 bad input, 4 cannot write, 5 no valid result, "
    "70 bug";

std::string version_text(const ToolInfo& info) {
    std::string text = info.name + " " + kLibraryVersion + " (file format " +
                       std::to_string(kFormatVersion[0]) + "." + std::to_string(kFormatVersion[1]) + ")";
    for (const std::string& library : info.libraries)
        text += "\n  " + library;
    return text;
}

void declare_common(CLI::App& app, const ToolInfo& info, ToolContext& context) {
    const std::string group = "Common options";
    if (info.uses_threads) {
        context.threads = std::max(1U, std::thread::hardware_concurrency());
        app.add_option("-j,--threads", context.threads, "worker threads; the result does not depend on it")
            ->check(CLI::Range(1U, 1024U))
            ->group(group);
    }
    if (info.uses_seed)
        app.add_option("--seed", context.seed, "seed of the random numbers; recorded in the output")
            ->capture_default_str()
            ->group(group);
    if (info.writes_report)
        app.add_option("--report", context.report_file, "also write counts and timings as JSON")
            ->type_name("FILE")
            ->group(group);
    if (info.writes_depfile)
        app.add_option("--depfile", context.depfile, "also write a Makefile-style dependency file")
            ->type_name("FILE")
            ->group(group);
    auto* quiet = app.add_flag("-q,--quiet", context.quiet, "only warnings and errors")->group(group);
    app.add_flag("-v,--verbose", context.verbose, "say more")->excludes(quiet)->group(group);
    app.set_help_flag("-h,--help", "print this help")->group(group);
    app.set_version_flag("--version", version_text(info))->group(group);
}

int report_error(const ToolInfo& info, ExitCode code, const std::string& message) {
    std::cerr << info.name << ": error: " << message << '\n';
    return static_cast<int>(code);
}

/// A make target or prerequisite: blanks, '#', '\' and '$' would otherwise mean something to make.
std::string escaped_for_make(const std::filesystem::path& file) {
    std::string escaped;
    for (const char c : file.string()) {
        if (c == ' ' || c == '#' || c == '\\') escaped += '\\';
        if (c == '$') escaped += '$';
        escaped += c;
    }
    return escaped;
}

}  // namespace

void ToolContext::tell(std::string_view text) const {
    if (!quiet) std::cerr << info_.name << ": " << text << '\n';
}

void ToolContext::detail(std::string_view text) const {
    if (verbose) tell(text);
}

void ToolContext::warn(std::string_view text) const {
    std::cerr << info_.name << ": warning: " << text << '\n';
}

void ToolContext::write_report(const std::string& json) const {
    if (!report_file.empty()) value_or_throw(write_text_file(report_file, json));
}

void ToolContext::write_depfile() const {
    if (depfile.empty()) return;
    std::string text = escaped_for_make(output_) + ":";
    for (const auto& input : inputs_)
        text += " \\\n  " + escaped_for_make(input);
    value_or_throw(write_text_file(depfile, text + "\n"));
}

Provenance ToolContext::provenance(std::vector<std::string> canonical_arguments) const {
    Provenance provenance;
    provenance.tool = info_.name;
    provenance.tool_version = kLibraryVersion;
    provenance.arguments = std::move(canonical_arguments);
    provenance.seed = info_.uses_seed ? seed : 0;
    return provenance;
}

int run_tool(int argc, char** argv, const ToolInfo& info, const std::function<void(CLI::App&)>& declare,
             const std::function<ExitCode(ToolContext&)>& body) {
    try {
        CLI::App app{info.name + ": " + info.purpose, info.name};
        ToolContext context(info);
        declare(app);
        declare_common(app, info, context);
        app.footer("Example: " + info.example + "\n" + kExitStatus);
        try {
            app.parse(argc, argv);
        } catch (const CLI::ParseError& error) {
            if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
            return report_error(info, ExitCode::bad_usage,
                                std::string(error.what()) + " (see " + info.name + " --help)");
        }
        const ExitCode code = body(context);
        if (code == ExitCode::done) context.write_depfile();
        std::cout.flush();
        if (!std::cout) return report_error(info, ExitCode::cannot_write, "standard output: cannot write");
        return static_cast<int>(code);
    } catch (const ToolError& error) {
        return report_error(info, error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return report_error(info, ExitCode::no_valid_result, "not enough memory");
    } catch (const std::exception& error) {
        return report_error(info, ExitCode::bug,
                            std::string("internal error, please report it: ") + error.what());
    } catch (...) {
        return report_error(info, ExitCode::bug, "internal error, please report it");
    }
}

void require_writable_folder(const std::filesystem::path& output) {
    const auto folder = output.has_parent_path() ? output.parent_path() : std::filesystem::path(".");
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored))
        throw ToolError(ExitCode::cannot_write,
                        output.string() + ": the folder " + folder.string() + " does not exist");
    if (std::filesystem::is_directory(output, ignored))
        throw ToolError(ExitCode::cannot_write, output.string() + ": is a folder");
}

}  // namespace knead::tools
