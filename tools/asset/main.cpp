// SPDX-License-Identifier: GPL-3.0-or-later
// knead-asset: looks into the files of Knead.
#include <iostream>

#include "asset/commands.h"
#include "asset/export_mesh.h"
#include "asset/info.h"
#include "common/run_tool.h"
#include "knead/formats/write/write.h"

namespace knead::tools {
namespace {

namespace fs = std::filesystem;

struct Options {
    CLI::App* info = nullptr;
    CLI::App* validate = nullptr;
    CLI::App* diff = nullptr;
    CLI::App* export_command = nullptr;
    fs::path file;
    fs::path other;
    fs::path output;
    bool json = false;
    std::vector<std::string> absolute;
    std::vector<std::string> relative;
};

CLI::App* add_command(CLI::App& app, const char* name, const char* purpose) {
    CLI::App* command = app.add_subcommand(name, purpose);
    command->fallthrough();  // common options may follow the command
    return command;
}

void declare(CLI::App& app, Options& options) {
    app.require_subcommand(1);
    options.info = add_command(app, "info", "say what is in a file, and what asked for it");
    options.info->add_option("FILE", options.file, "any file of Knead")->required();
    options.info->add_flag("--json", options.json, "print JSON");
    options.validate =
        add_command(app, "validate", "check a file completely; exit 1 and one line per issue if it fails");
    options.validate->add_option("FILE", options.file, "any file of Knead")->required();
    options.diff = add_command(app, "diff", "compare two files dataset by dataset; exit 1 if they differ");
    options.diff->add_option("A", options.file, "first file")->required();
    options.diff->add_option("B", options.other, "second file")->required();
    const char* const tolerance_type = "[DATASET=]NUMBER";
    options.diff->add_option("--abs", options.absolute, "absolute tolerance of floating-point data [0]")
        ->type_name(tolerance_type)
        ->allow_extra_args(false);
    options.diff->add_option("--rel", options.relative, "relative tolerance of floating-point data [0]")
        ->type_name(tolerance_type)
        ->allow_extra_args(false);
    options.export_command = add_command(app, "export", "write the mesh with its values for another program");
    options.export_command->add_option("FILE", options.file, "a file with a mesh")->required();
    options.export_command->add_option("-o,--output", options.output, ".vtu (ParaView) or .msh (gmsh 2.2)")
        ->type_name("FILE")
        ->required();
}

ExitCode run_info(const Options& options) {
    Description description{value_or_throw(inspect_file(options.file)), {}};
    if (description.file.header.kind == FileKind::asset)
        description.asset = value_or_throw(read_asset(options.file));
    std::cout << (options.json ? info_json(description) : info_text(description));
    return ExitCode::done;
}

ExitCode run_validate(const Options& options, const ToolContext& context) {
    const Result<FileKind> result = validate_file(options.file);
    if (result.ok()) {
        if (!context.quiet)
            std::cout << options.file.string() << ": valid (" << to_string(result.value()) << ")\n";
        return ExitCode::done;
    }
    const ErrorCode code = result.error().code;
    if (code == ErrorCode::io_error || code == ErrorCode::out_of_memory) (void)value_or_throw(result);
    std::cout << issue_line(result.error()) << "\n";
    return ExitCode::answer_is_no;
}

ExitCode run_diff(const Options& options, const ToolContext& context) {
    const CompareOptions tolerances = compare_options(options.absolute, options.relative);
    const auto result = compare_files(options.file, options.other, tolerances);
    if (!result.ok() && result.error().code == ErrorCode::invalid_argument) fail_usage(result.error().text());
    const std::vector<Difference> differences = value_or_throw(result);
    if (!context.quiet)
        for (const Difference& difference : differences)
            std::cout << difference.path << ": " << difference.message << "\n";
    return differences.empty() ? ExitCode::done : ExitCode::answer_is_no;
}

ExportMesh read_for_export(const fs::path& file) {
    switch (value_or_throw(read_header(file)).kind) {
        case FileKind::tet_mesh:
            return export_mesh(value_or_throw(read_tet_mesh(file)));
        case FileKind::material:
            return export_mesh(value_or_throw(read_material(file)));
        case FileKind::clustering:
            return export_mesh(value_or_throw(read_clustering(file)));
        case FileKind::asset:
            return export_mesh(value_or_throw(read_asset(file)));
        case FileKind::overlap:
        case FileKind::session:
            break;
    }
    fail_input(file.string() + ": an overlap or a session has no mesh to export");
}

ExitCode run_export(const Options& options, ToolContext& context) {
    const std::string extension = options.output.extension().string();
    if (extension != ".vtu" && extension != ".msh")
        fail_usage(options.output.string() + ": the extension says the format, .vtu or .msh");
    require_writable_folder(options.output);
    context.add_input(options.file);
    context.set_output(options.output);
    const ExportMesh mesh = read_for_export(options.file);
    value_or_throw(write_text_file(options.output, extension == ".vtu" ? vtu_text(mesh) : msh_text(mesh)));
    return ExitCode::done;
}

}  // namespace
}  // namespace knead::tools

int main(int argc, char** argv) {
    using namespace knead::tools;
    ToolInfo info{"knead-asset",
                  "look into the files of Knead: info, validate, diff, export",
                  "knead-asset info liver.asset.hdf",
                  {}};
    info.writes_report = false;
    info.writes_depfile = false;
    Options options;
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare(app, options); },
        [&](ToolContext& context) {
            if (options.info->parsed()) return run_info(options);
            if (options.validate->parsed()) return run_validate(options, context);
            if (options.diff->parsed()) return run_diff(options, context);
            return run_export(options, context);
        });
}
