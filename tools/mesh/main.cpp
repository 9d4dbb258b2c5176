// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/run_tool.h"
#include "common/stopwatch.h"
#include "knead/formats/write/write.h"
#include "mesh/geometry.h"
#include "mesh/gmsh_primitives.h"
#include "mesh/gmsh_session.h"
#include "mesh/import.h"
#include "mesh/options.h"
#include "mesh/outline.h"
#include "mesh/source_files.h"
#include "quality/mesh_quality.h"
#include "quality/report_text.h"

namespace knead::tools {
namespace {

/// Runs what reads a file and puts the file's name in front of what it complains about.
template <class Body>
auto naming(const std::filesystem::path& file, const Body& body) {
    try {
        return body();
    } catch (const ToolError& error) {
        throw ToolError(error.code(), file.string() + ": " + error.what());
    }
}

OutlineSlab read_slab(const MeshOptions& options, SourceFiles& files) {
    const double unit = options.length_unit.empty() ? 1.0 : metres_per_unit(options.length_unit);
    OutlineSlab slab;
    slab.corners_m = naming(options.file, [&] { return read_outline(files.read(options.file, "points")); });
    for (auto& corner : slab.corners_m)
        for (double& x : corner)
            x *= unit;
    slab.thickness_m = length_m(options.thickness, "--thickness");
    slab.round_m = parse_length_m(options.round);
    slab.polygon = options.polygon;
    return slab;
}

MadeMesh import_file(const MeshOptions& options, SourceFiles& files) {
    ImportRequest request;
    request.extension = options.file.extension().string();
    if (!options.length_unit.empty()) request.metres_per_unit = metres_per_unit(options.length_unit);
    request.size = options.size();
    request.merge_duplicate_nodes = options.merge_duplicate_nodes;
    request.repair_orientation = options.repair_orientation;
    request.include = files.include_reader(options.file);
    return naming(options.file, [&] { return import_mesh(files.read(options.file, "source"), request); });
}

MadeMesh make(const MeshOptions& options, SourceFiles& files) {
    const MeshSize size = options.size();
    if (options.command == "cubes")
        return {make_cubes(divisions(options), lengths_m(options.lengths, "--size")), {}, "cubes"};
    if (options.command == "box")
        return finish(mesh_box(lengths_m(options.lengths, "--size"), size), "a box");
    if (options.command == "sphere")
        return finish(mesh_sphere(length_m(options.radius, "--radius"), size), "a sphere");
    if (options.command == "cylinder")
        return finish(
            mesh_cylinder(length_m(options.radius, "--radius"), length_m(options.height, "--height"), size),
            "a cylinder");
    if (options.command == "ellipsoid")
        return finish(mesh_ellipsoid(lengths_m(options.lengths, "--radii"), size), "an ellipsoid");
    if (options.command == "outline")
        return finish(mesh_outline(read_slab(options, files), size), "an outline");
    return import_file(options, files);
}

std::string report(const MadeMesh& made, const MeshQuality& quality, const MeshOptions& options,
                   double seconds) {
    nlohmann::ordered_json json;
    json["tool"] = "knead-mesh";
    json["arguments"] = canonical_arguments(options);
    json["source"] = made.source;
    json["nodes"] = made.mesh.nodes_m.size();
    json["tetrahedra"] = made.mesh.tetrahedra.size();
    if (options.target_tetrahedra) json["target_tetrahedra"] = *options.target_tetrahedra;
    if (made.edge_length_m > 0) json["edge_length_m"] = made.edge_length_m;
    json["meshings"] = made.meshings;
    json["regions"] = made.mesh.regions.names;
    json["cell_arrays"] = nlohmann::json::array();
    for (const CellArray& array : made.mesh.cell_arrays)
        json["cell_arrays"].push_back(array.name);
    json["bodies"] = quality.bodies;
    json["volume_m3"] = quality.volume_m3;
    json["bounding_box_m"] = {quality.low_m, quality.high_m};
    json["radius_ratio"] = {{"min", quality.min_radius_ratio}, {"mean", quality.mean_radius_ratio}};
    json["slivers"] = quality.slivers.size();
    json["quality"] = to_json(quality);
    json["notes"] = nlohmann::json::array();
    for (const Note& note : made.notes)
        json["notes"].push_back({{"warning", note.warning}, {"text", note.text}});
    json["seconds"] = seconds;
    return json.dump(2) + "\n";
}

void say(const ToolContext& context, const MadeMesh& made, const MeshQuality& quality) {
    for (const Note& note : made.notes)
        note.warning ? context.warn(note.text) : context.tell(note.text);
    context.tell(
        fmt::format("{} nodes, {} tetrahedra", made.mesh.nodes_m.size(), made.mesh.tetrahedra.size()));
    context.detail(fmt::format("volume {:.6g} m^3, radius ratio {:.3f} at least, {:.3f} on average",
                               quality.volume_m3, quality.min_radius_ratio, quality.mean_radius_ratio));
    if (made.edge_length_m > 0)
        context.detail(
            fmt::format("edge length {:.6g} m, meshed {} times", made.edge_length_m, made.meshings));
}

ExitCode run(ToolContext& context, const MeshOptions& options) {
    const Stopwatch total;
    context.set_output(options.output);
    require_writable_folder(options.output);
    SourceFiles files([&](const std::filesystem::path& file) { context.add_input(file); });
    MadeMesh made = make(options, files);
    const MeshQuality quality = measure(made.mesh);
    for (Note& note : remarks(made.mesh, quality))
        made.notes.push_back(std::move(note));
    say(context, made, quality);
    Provenance provenance = context.provenance(canonical_arguments(options));
    provenance.inputs = files.hashes();
    value_or_throw(write_tet_mesh(options.output, made.mesh, provenance));
    const double elapsed_s = total.seconds();
    context.write_report(report(made, quality, options, elapsed_s));
    return ExitCode::done;
}

}  // namespace
}  // namespace knead::tools

int main(int argc, char** argv) {
    using namespace knead::tools;
    MeshOptions options;
    const ToolInfo info{
        .name = "knead-mesh",
        .purpose = "make a tetrahedral mesh from a shape, a surface or an existing mesh.",
        .example = "knead-mesh import liver.stl --length-unit mm --target-tetrahedra 3000 -o liver.hdf",
        .libraries = {gmsh_version()}};
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare_options(app, options); },
        [&](ToolContext& context) { return run(context, options); });
}
