// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bake/bake.h"
#include "common/run_tool.h"
#include "common/stopwatch.h"
#include "knead/formats/hash.h"
#include "knead/formats/write/write.h"

namespace {

using namespace knead;
using namespace knead::tools;

struct Options {
    std::filesystem::path scene;
    std::filesystem::path object;
    std::filesystem::path output;
    std::string level;
};

void declare(CLI::App& app, Options& options) {
    app.add_option("SCENE", options.scene, "scene file (TOML)")->required();
    app.add_option("OBJECT", options.object, "mesh and material of the level")->required();
    app.add_option("-l,--level", options.level, "name of the level in the scene")->required();
    app.add_option("-o,--output", options.output, "asset to write; replaced only once complete")->required();
}

std::string report(const Asset& asset, double seconds) {
    nlohmann::ordered_json json;
    json["schema"] = "knead-bake/1";
    json["nodes"] = asset.nodes_m.size();
    json["free_nodes"] = asset.free_node_count;
    json["tetrahedra"] = asset.tetrahedra.size();
    json["palette"] = asset.palette.size();
    for (const ToolSet& tool : asset.tools)
        json["tools"][tool.name] = tool.nodes.size();
    json["seconds"] = seconds;
    return json.dump(2) + "\n";
}

ExitCode run(ToolContext& context, const Options& options) {
    const Stopwatch total;
    require_writable_folder(options.output);
    context.add_input(options.scene);
    context.add_input(options.object);
    context.set_output(options.output);

    const Scene scene = read_scene(options.scene);
    const Level& level = scene.level(options.level);
    const FileHeader header = value_or_throw(read_header(options.object));
    const MaterialObject object = value_or_throw(read_material(options.object));
    const Asset asset = bake(scene, level, object);

    Provenance provenance = context.provenance({"--level=" + options.level});
    provenance.inputs = {{"scene", value_or_throw(sha256_of_file(options.scene))},
                         {"object", header.content_hash}};
    value_or_throw(write_asset(options.output, asset, provenance));

    context.detail(fmt::format("{} of {} tetrahedra, {} free nodes, {} elasticities", asset.tetrahedra.size(),
                               object.mesh.tetrahedra.size(), asset.free_node_count, asset.palette.size()));
    context.write_report(report(asset, total.seconds()));
    return ExitCode::done;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    ToolInfo info;
    info.name = "knead-bake";
    info.purpose = "write the asset of one level of a scene: only what the scene needs.";
    info.example = "knead-bake steak.toml steak.k3.coarse.hdf --level k3 -o steak.k3.hdf";
    info.libraries = {"METIS " KNEAD_METIS_VERSION};
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare(app, options); },
        [&](ToolContext& context) { return run(context, options); });
}
