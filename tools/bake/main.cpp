// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bake/bake.h"
#include "common/input.h"
#include "common/run_tool.h"
#include "common/stopwatch.h"
#include "knead/formats/hash.h"
#include "knead/formats/numerics.h"
#include "knead/formats/write/write.h"
#include "quality/report_text.h"

namespace {

using namespace knead;
using namespace knead::tools;

struct Options {
    std::filesystem::path scene;
    std::filesystem::path object;
    std::filesystem::path output;
    std::string level;
    bool strict = false;
};

void declare(CLI::App& app, Options& options) {
    app.add_option("SCENE", options.scene, "scene file (TOML)")->required();
    app.add_option("OBJECT", options.object, "mesh and material of the level")->required();
    app.add_option("-l,--level", options.level, "name of the level in the scene")->required();
    app.add_option("-o,--output", options.output, "asset to write; replaced only once complete")->required();
    app.add_flag("--strict", options.strict,
                 "with a warning of the quality gate: write no asset, exit with 1");
}

/// Empty when the scene asks for none.
Input<Skin> read_scene_skin(ToolContext& context, const Scene& scene) {
    if (!scene.embedding) return {};
    const std::filesystem::path& file = scene.embedding->file;
    const Input<std::string> bytes = read_input_bytes(context, file);
    Skin skin = about(file, [&] {
        return read_skin(bytes.value, file.extension().string(), scene.embedding->metres_per_unit);
    });
    for (const std::string& note : skin.notes)
        context.tell(file.string() + ": " + note);
    return {std::move(skin), bytes.content_hash};
}

std::string report(const Asset& asset, const QualityReport& quality, double seconds) {
    nlohmann::ordered_json json;
    json["schema"] = "knead-bake/1";
    json["nodes"] = asset.nodes_m.size();
    json["free_nodes"] = asset.free_node_count;
    json["tetrahedra"] = asset.tetrahedra.size();
    json["palette"] = asset.palette.size();
    for (const ToolSet& tool : asset.tools)
        json["tools"][tool.name] = tool.nodes.size();
    if (!asset.embedding.triangles.empty())
        json["embedding"] = {{"vertices", asset.embedding.vertex_count()},
                             {"still_vertices", asset.embedding.still_vertices_m.size()},
                             {"triangles", asset.embedding.triangles.size()}};
    const Numerics& numerics = quality.conditioning.numerics;
    json["numerics"] = {{"arithmetic", to_string(numerics.arithmetic)},
                        {"arithmetic_reason", to_string(numerics.arithmetic_reason)},
                        {"preconditioner", to_string(numerics.preconditioner)},
                        {"preconditioner_reason", to_string(numerics.preconditioner_reason)},
                        {"factor_storage", to_string(numerics.factor_storage)},
                        {"storage_reason", to_string(numerics.storage_reason)},
                        {"contrast", numerics.contrast},
                        {"press_contrast", numerics.press_contrast},
                        {"max_poissons_ratio", numerics.max_poissons_ratio}};
    json["quality"] = to_json(quality);
    json["seconds"] = seconds;
    return json.dump(2) + "\n";
}

void say(const ToolContext& context, const QualityReport& quality) {
    for (const std::string& line : to_lines(quality))
        context.detail(line);
    for (const Finding& finding : quality.findings)
        finding.warning ? context.warn(to_text(finding)) : context.detail(to_text(finding));
}

ExitCode run(ToolContext& context, const Options& options) {
    const Stopwatch total;
    require_writable_folder(options.output);
    context.add_input(options.scene);
    context.set_output(options.output);

    const Scene scene = read_scene(options.scene);
    const Level& level = scene.level(options.level);
    const auto [object, object_hash] = read_input<MaterialObject>(context, options.object);
    const Input<Skin> skin = read_scene_skin(context, scene);
    const Asset asset = bake(scene, level, object, skin.value);

    context.detail(fmt::format("{} of {} tetrahedra, {} free nodes, {} elasticities", asset.tetrahedra.size(),
                               object.mesh.tetrahedra.size(), asset.free_node_count, asset.palette.size()));
    context.detail(to_text(choose_numerics(asset)));
    const QualityReport quality = examine(asset);
    say(context, quality);
    if (options.strict && quality.warning_count() > 0) {
        context.write_report(report(asset, quality, total.seconds()));
        throw ToolError(
            ExitCode::answer_is_no,
            fmt::format("{}: not written, because of {} {} and --strict", options.output.string(),
                        quality.warning_count(), quality.warning_count() == 1 ? "warning" : "warnings"));
    }

    Provenance provenance = context.provenance({"--level=" + options.level});
    provenance.inputs = {{"scene", value_or_throw(sha256_of_file(options.scene))}, {"object", object_hash}};
    if (scene.embedding) provenance.inputs.emplace_back("embedding", skin.content_hash);
    value_or_throw(write_asset(options.output, asset, provenance));
    context.write_report(report(asset, quality, total.seconds()));
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
