// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/options.h"

#include <fmt/format.h>

#include "common/run_tool.h"

namespace knead::tools {
namespace {

CLI::App* add_command(CLI::App& app, MeshOptions& options, const std::string& name,
                      const std::string& purpose) {
    CLI::App* command = app.add_subcommand(name, purpose);
    command->fallthrough();  // the common options stand behind the command's own
    command->callback([&options, name] { options.command = name; });
    command->add_option("-o,--output", options.output, "mesh to write (.hdf); replaced only once complete")
        ->type_name("FILE")
        ->required();
    return command;
}

void add_lengths(CLI::App* command, const std::string& name, MeshOptions& options, const std::string& text) {
    command
        ->add_option(name, options.lengths, text + "; one length for all three, or three (\"4mm\", \"0.1\")")
        ->type_name("LENGTH")
        ->expected(1, 3)
        ->required();
}

void add_length(CLI::App* command, const std::string& name, std::string& value, const std::string& text,
                bool required) {
    auto* option = command->add_option(name, value, text)->type_name("LENGTH");
    if (required) option->required();
}

void add_mesh_size(CLI::App* command, MeshOptions& options) {
    auto* target =
        command
            ->add_option("--target-tetrahedra", options.target_tetrahedra, "aim for this number, within 3 %")
            ->type_name("N")
            ->check(CLI::Range(std::size_t{1}, std::size_t{50'000'000}));
    command->add_option("--edge-length", options.edge_length, "length of the edges to aim for")
        ->type_name("LENGTH")
        ->excludes(target);
}

void add_import(CLI::App& app, MeshOptions& options) {
    CLI::App* command =
        add_command(app, options, "import",
                    "STEP or BREP solids and closed surfaces (STL, PLY), meshed; or an existing mesh (MSH, "
                    "Medit, legacy VTK, VegaFEM)");
    command->add_option("FILE", options.file, "file to import; its content decides how")->required();
    command
        ->add_option("--length-unit", options.length_unit,
                     "unit of its coordinates: m, dm, cm, mm, um, in, ft; needed by all formats but STEP")
        ->type_name("UNIT");
    command->add_flag("--merge-duplicate-nodes", options.merge_duplicate_nodes,
                      "join nodes of a mesh at exactly the same place");
    command->add_flag("--repair-orientation", options.repair_orientation,
                      "turn inverted tetrahedra of a mesh round even when only some are");
    add_mesh_size(command, options);
}

std::string number(double value) {
    return fmt::format("{}", value);
}

void append_lengths(std::vector<std::string>& arguments, const char* option,
                    const std::vector<std::string>& texts) {
    arguments.emplace_back(option);
    for (const double length : lengths_m(texts, option))
        arguments.push_back(number(length));
}

void append_length(std::vector<std::string>& arguments, const char* option, double length) {
    arguments.emplace_back(option);
    arguments.push_back(number(length));
}

}  // namespace

void declare_options(CLI::App& app, MeshOptions& options) {
    app.require_subcommand(1);
    CLI::App* cubes =
        add_command(app, options, "cubes", "a box of sub-cubes of six tetrahedra each, as in the paper");
    cubes
        ->add_option("--divisions", options.divisions,
                     "sub-cubes along x, y and z; one number for all three, or three")
        ->type_name("N")
        ->expected(1, 3)
        ->required();
    add_lengths(cubes, "--size", options, "size of the whole box");

    CLI::App* box = add_command(app, options, "box", "a box with a corner at the origin");
    add_lengths(box, "--size", options, "its sides");
    add_mesh_size(box, options);

    CLI::App* sphere = add_command(app, options, "sphere", "a ball around the origin");
    add_length(sphere, "--radius", options.radius, "its radius", true);
    add_mesh_size(sphere, options);

    CLI::App* cylinder = add_command(app, options, "cylinder", "a cylinder around the z axis, from z = 0 up");
    add_length(cylinder, "--radius", options.radius, "its radius", true);
    add_length(cylinder, "--height", options.height, "its height", true);
    add_mesh_size(cylinder, options);

    CLI::App* ellipsoid = add_command(app, options, "ellipsoid", "an ellipsoid around the origin");
    add_lengths(ellipsoid, "--radii", options, "its radii");
    add_mesh_size(ellipsoid, options);

    CLI::App* outline = add_command(app, options, "outline", "a slab with a free outline, from z = 0 up");
    outline->add_option("--points", options.file, "corners of the closed outline: x,y on each line")
        ->type_name("FILE")
        ->required();
    outline
        ->add_option("--length-unit", options.length_unit,
                     "unit of the points: m, dm, cm, mm, um, in, ft [m]")
        ->type_name("UNIT");
    add_length(outline, "--thickness", options.thickness, "height of the slab", true);
    outline->add_flag("--polygon", options.polygon,
                      "straight sides instead of a smooth curve through the corners");
    add_length(outline, "--round", options.round, "radius of the rounded upper and lower edges [0]", false);
    add_mesh_size(outline, options);

    add_import(app, options);
}

double length_m(const std::string& text, const char* option) {
    const double length = parse_length_m(text);
    if (!(length > 0)) fail_usage(fmt::format("{}: \"{}\" is not greater than 0", option, text));
    return length;
}

std::array<double, 3> lengths_m(const std::vector<std::string>& texts, const char* option) {
    if (texts.size() != 1 && texts.size() != 3)
        fail_usage(fmt::format("{}: one length or three, not {}", option, texts.size()));
    const auto at = [&](std::size_t axis) { return length_m(texts[texts.size() == 1 ? 0 : axis], option); };
    return {at(0), at(1), at(2)};
}

std::array<std::uint32_t, 3> divisions(const MeshOptions& options) {
    const auto& d = options.divisions;
    if (d.size() != 1 && d.size() != 3)
        fail_usage(fmt::format("--divisions: one number or three, not {}", d.size()));
    return d.size() == 1 ? std::array<std::uint32_t, 3>{d[0], d[0], d[0]}
                         : std::array<std::uint32_t, 3>{d[0], d[1], d[2]};
}

MeshSize MeshOptions::size() const {
    MeshSize size;
    size.target_tetrahedra = target_tetrahedra;
    if (!edge_length.empty()) size.edge_length_m = length_m(edge_length, "--edge-length");
    return size;
}

std::vector<std::string> canonical_arguments(const MeshOptions& options) {
    std::vector<std::string> arguments{options.command};
    if (options.command == "cubes") {
        arguments.emplace_back("--divisions");
        for (const std::uint32_t n : divisions(options))
            arguments.push_back(std::to_string(n));
    }
    if (!options.lengths.empty())
        append_lengths(arguments, options.command == "ellipsoid" ? "--radii" : "--size", options.lengths);
    if (!options.radius.empty()) append_length(arguments, "--radius", length_m(options.radius, "--radius"));
    if (!options.height.empty()) append_length(arguments, "--height", length_m(options.height, "--height"));
    if (options.command == "outline") {
        append_length(arguments, "--thickness", length_m(options.thickness, "--thickness"));
        append_length(arguments, "--round", parse_length_m(options.round));
        if (options.polygon) arguments.emplace_back("--polygon");
    }
    if (!options.length_unit.empty()) {
        arguments.emplace_back("--length-unit");
        arguments.push_back(options.length_unit);
    }
    if (options.merge_duplicate_nodes) arguments.emplace_back("--merge-duplicate-nodes");
    if (options.repair_orientation) arguments.emplace_back("--repair-orientation");
    if (options.target_tetrahedra) {
        arguments.emplace_back("--target-tetrahedra");
        arguments.push_back(std::to_string(*options.target_tetrahedra));
    }
    if (!options.edge_length.empty())
        append_length(arguments, "--edge-length", length_m(options.edge_length, "--edge-length"));
    return arguments;
}

}  // namespace knead::tools
