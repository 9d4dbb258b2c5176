// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/prepared_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "bake/bake.h"
#include "bake/selection.h"
#include "common/error.h"
#include "evaluate/bytes.h"
#include "knead/formats/hash.h"
#include "scene/toml_table.h"

namespace knead::tools {
namespace {

constexpr const char* kFine = "fine";
constexpr const char* kSceneLoad = "scene";

std::string hash_of(const TetMesh& mesh) {
    std::string bytes;
    append_bytes(bytes, mesh.nodes_m);
    append_bytes(bytes, mesh.tetrahedra);
    return sha256_of(bytes);
}

double root_sum(const std::vector<Point>& values) {
    double sum = 0;
    for (const Point& value : values)
        for (const double x : value)
            sum += x * x;
    return std::sqrt(sum);
}

std::vector<bool> held_nodes(const Scene& scene, const TetMesh& mesh) {
    std::vector<bool> held(mesh.nodes_m.size(), false);
    for (const Selection& selection : scene.held) {
        const std::vector<bool> selected = select_nodes(mesh, selection);
        for (std::size_t n = 0; n < held.size(); ++n)
            if (selected[n]) held[n] = true;
    }
    return held;
}

/// What stands in for the elasticities where only places matter.
Material any_material(const TetMesh& mesh) {
    const std::size_t count = mesh.tetrahedra.size();
    return {std::vector<double>(count, 1.0),
            std::vector<double>(count, 0.3),
            std::vector<double>(count, 1000.0),
            {}};
}

/// "scene" or "scene:NAME" as the index of the tool.
std::size_t tool_index(const Scene& scene, const std::string& load) {
    if (load == kSceneLoad) return 0;
    const std::string wanted = load.substr(std::string(kSceneLoad).size() + 1);
    std::vector<std::string> names;
    for (std::size_t k = 0; k < scene.tools.size(); ++k) {
        if (scene.tools[k].name == wanted) return k;
        names.push_back(scene.tools[k].name);
    }
    const std::string near = nearest_word(wanted, names);
    fail_usage(fmt::format("{}: has no tool \"{}\"{}", scene.file.string(), wanted,
                           near.empty() ? "" : fmt::format("; did you mean scene:{}?", near)));
}

bool is_scene_load(const std::string& load) {
    return load == kSceneLoad || load.rfind(std::string(kSceneLoad) + ":", 0) == 0;
}

MeshLoad scene_load(const PreparedScene& prepared, const PreparedMesh& mesh, const std::string& name,
                    const Box& object) {
    const TetMesh& tets = mesh.level.mesh;
    const std::size_t tool = tool_index(prepared.scene, name);
    Scene bare = prepared.scene;  // only the places of the tools' nodes are wanted
    bare.embedding.reset();
    const Asset asset = bake(bare, bare.levels.front(), {tets, any_material(tets)});
    MeshLoad load;
    load.name = name;
    load.press = tool_press(asset, tool, tets, object);
    load.applied = apply_press(*load.press, mesh.is_held);
    if (load.in_contact()) {  // what is prescribed is what is held
        load.applied.motion.nodes.resize(load.applied.held_count);
        load.applied.motion.displacement_m.resize(load.applied.held_count);
        load.applied.work_directions.clear();
    }
    return load;
}

std::optional<std::uint32_t> number_of(const std::string& text) {
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number == 0) return std::nullopt;
    return number;
}

/// The scene's mesh with another number of tetrahedra.
MeshSource resized(const Scene& scene, std::uint32_t tetrahedra) {
    MeshSource source = scene.mesh;
    if (source.kind != "cubes") {
        source.edge_length_m = 0;
        source.target_tetrahedra = tetrahedra;
        return source;
    }
    const auto divisions = static_cast<std::uint32_t>(std::lround(std::cbrt(tetrahedra / 6.0)));
    if (6 * divisions * divisions * divisions != tetrahedra)
        fail_usage(fmt::format("level {}: cubes have 6 n^3 tetrahedra; the nearest are {}", tetrahedra,
                               6 * divisions * divisions * divisions));
    source.divisions = {divisions};
    return source;
}

}  // namespace

std::optional<MeshSource> level_source(const Scene& scene, const std::string& level) {
    if (level == kFine) return std::nullopt;
    std::vector<std::string> names{kFine};
    for (const Level& known : scene.levels) {
        if (known.name == level) return known.mesh == scene.mesh ? std::nullopt : known.mesh;
        names.push_back(known.name);
    }
    if (const auto tetrahedra = number_of(level)) {
        const MeshSource source = resized(scene, *tetrahedra);
        return source == scene.mesh ? std::nullopt : std::optional(source);
    }
    const std::string near = nearest_word(level, names);
    fail_usage(
        fmt::format("{}: has no level \"{}\"{}; a level is a name in the scene, \"fine\" or a number of "
                    "tetrahedra",
                    scene.file.string(), level, near.empty() ? "" : "; did you mean " + near + "?"));
}

std::vector<std::string> default_levels(const Scene& scene) {
    std::vector<std::string> levels;
    std::vector<MeshSource> seen;
    for (const Level& level : scene.levels) {
        if (!level.mesh || std::find(seen.begin(), seen.end(), *level.mesh) != seen.end()) continue;
        seen.push_back(*level.mesh);
        levels.push_back(level.name);
    }
    if (levels.empty()) levels.emplace_back(kFine);
    return levels;
}

PreparedMesh prepare_mesh(const PreparedScene& prepared, TetMesh mesh, bool is_fine,
                          const std::vector<std::string>& loads) {
    const TetMesh& fine = prepared.fine.level.mesh;
    PreparedMesh result;
    result.level = make_level_mesh(fine, std::move(mesh), is_fine);
    const TetMesh& tets = result.level.mesh;
    result.hash = hash_of(tets);
    result.is_held = held_nodes(prepared.scene, tets);
    const Box object = bounding_box(fine.nodes_m);
    for (const std::string& name : loads) {
        if (is_scene_load(name)) {
            result.loads.push_back(scene_load(prepared, result, name, object));
            continue;
        }
        MeshLoad load;
        load.name = name;
        load.applied = apply_load(named_load(name, object), tets, result.is_held);
        result.loads.push_back(std::move(load));
    }
    result.outer = surface_nodes(tets);
    std::vector<Point> points;
    for (const std::uint32_t node : result.outer)
        points.push_back(tets.nodes_m[node]);
    const TetMesh& reference =
        prepared.reference.level.mesh.tetrahedra.empty() ? tets : prepared.reference.level.mesh;
    result.places = interpolate(points, reference);
    return result;
}

PreparedScene prepare(const std::filesystem::path& file, const EvaluationRequest& request,
                      const FileReader& read) {
    PreparedScene prepared;
    prepared.scene = read_scene(file);
    const Scene& scene = prepared.scene;
    if (scene.tools.empty()) fail_input(file.string() + ": has no tool, so there is no force to compare");
    if (scene.held.empty())
        fail_input(file.string() + ": holds nothing ([[held]]), so the object does not resist a load");
    for (const std::string& load : request.loads)
        if (is_scene_load(load)) (void)tool_index(scene, load);
    const std::vector<std::string> levels = request.levels.empty() ? default_levels(scene) : request.levels;
    std::vector<std::optional<MeshSource>> sources;
    for (const std::string& level : levels)
        sources.push_back(level_source(scene, level));
    if (scene.embedding) {
        const EmbeddingSource& embedding = *scene.embedding;
        prepared.skin =
            read_skin(read(embedding.file), embedding.file.extension().string(), embedding.metres_per_unit);
    }
    prepared.fine.level.mesh = make_mesh(scene.mesh, read);
    const TetMesh& fine = prepared.fine.level.mesh;
    prepared.fine = prepare_mesh(prepared, fine, true, request.loads);
    prepared.reference = prepared.fine;
    if (request.reference == ReferenceKind::finer) {
        prepared.reference = {};
        prepared.reference =
            prepare_mesh(prepared, split_in_eight({fine, any_material(fine)}).mesh, true, request.loads);
    }
    for (const auto& source : sources) {
        PreparedMesh level = source ? prepare_mesh(prepared, make_mesh(*source, read), false, request.loads)
                                    : prepare_mesh(prepared, fine, true, request.loads);
        level.source = source.value_or(scene.mesh);
        const bool known = std::any_of(prepared.levels.begin(), prepared.levels.end(),
                                       [&](const PreparedMesh& other) { return other.hash == level.hash; });
        if (!known) prepared.levels.push_back(std::move(level));
    }
    return prepared;
}

Asset bake_level(const PreparedScene& prepared, const MaterialObject& object) {
    return bake(prepared.scene, prepared.scene.levels.front(), object, prepared.skin);
}

std::string hash_of(const PreparedMesh& mesh, const Material& material) {
    std::string bytes = mesh.hash;
    append_bytes(bytes, material.youngs_modulus_pa);
    append_bytes(bytes, material.poissons_ratio);
    append_bytes(bytes, material.density_kg_per_m3);
    return sha256_of(bytes);
}

double displacement_error(const PreparedMesh& mesh, const StaticAnswer& answer,
                          const StaticAnswer& reference) {
    const std::vector<Point> wanted = values_at(mesh.places, reference.displacement_m);
    std::vector<Point> difference = wanted;
    for (std::size_t k = 0; k < wanted.size(); ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            difference[k][axis] -= answer.displacement_m[mesh.outer[k]][axis];
    return root_sum(difference) / root_sum(wanted);
}

}  // namespace knead::tools
