// SPDX-License-Identifier: GPL-3.0-or-later
#include "tune/tuned_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "cluster/cluster.h"
#include "common/error.h"
#include "evaluate/bytes.h"
#include "evaluate/calibration.h"
#include "evaluate/kept_json.h"
#include "evaluate/pinned_thread.h"
#include "evaluate/region_adapted.h"
#include "knead/formats/hash.h"
#include "tune/mesh_range.h"
#include "tune/tune_loads.h"

namespace knead::tools {
namespace {

constexpr std::size_t kObjectsKept = 64;
constexpr std::size_t kReferencesKept = 2048;
constexpr std::size_t kAggregatedKept = 128;
constexpr std::size_t kLevelsKept = 32;
constexpr const char* kScene = "scene";

std::string to_cache(const LoadAnswer& answer) {
    return nlohmann::ordered_json{{"converged", answer.converged},
                                  {"problem", answer.problem},
                                  {"force_error", answer.converged ? answer.force_error : 0},
                                  {"displacement_error", answer.displacement_error}}
        .dump();
}

void read_answer(const nlohmann::ordered_json& json, LoadAnswer& answer) {
    answer.converged = json.at("converged").get<bool>();
    answer.problem = json.at("problem").get<std::string>();
    answer.force_error =
        answer.converged ? json.at("force_error").get<double>() : std::numeric_limits<double>::infinity();
    answer.displacement_error = json.at("displacement_error").get<double>();
}

bool is_scenes(const std::string& name) {
    return name == kScene || name.rfind("scene:", 0) == 0;
}

Material mixed(const MaterialObject& fine, const LevelMesh& level, std::uint32_t reuss_percent) {
    Material material = mean_material(MethodKind::voigt, fine, level);
    const Material reuss = mean_material(MethodKind::reuss, fine, level);
    const double share = reuss_percent / 100.0;
    for (std::size_t t = 0; t < material.youngs_modulus_pa.size(); ++t)
        material.youngs_modulus_pa[t] =
            (1 - share) * material.youngs_modulus_pa[t] + share * reuss.youngs_modulus_pa[t];
    return material;
}

}  // namespace

TunedScene::TunedScene(const std::filesystem::path& file, const LoadNames& names,
                       const std::vector<std::string>& levels, FileReader read, const ResultCache& cache)
    : read_(std::move(read)),
      cache_(cache),
      objects_(kObjectsKept),
      references_(kReferencesKept),
      aggregated_(kAggregatedKept),
      made_(kLevelsKept) {
    EvaluationRequest request;
    request.levels = {"fine"};
    request.loads = {kScene};
    for (const std::string& name : names.required)
        if (is_scenes(name) && name != kScene) request.loads.push_back(name);
    prepared_ = prepare(file, request, read_);
    scene_loads_ = loads_ = request.loads;
    for (const std::string& name : names.required) {
        if (is_scenes(name)) continue;
        prepared_.fine.loads.push_back(load_on(prepared_.fine, name));
        loads_.push_back(name);
    }
    for (const std::string& name : names.optional) {
        try {
            prepared_.fine.loads.push_back(load_on(prepared_.fine, name));
            loads_.push_back(name);
        } catch (const ToolError& error) {
            notes_.push_back(fmt::format("{}: left out: {}", name, error.what()));
        }
    }
    prepared_.reference.loads = prepared_.fine.loads;
    add_meshes(levels);
}

MeshLoad TunedScene::load_on(const PreparedMesh& mesh, const std::string& name) const {
    const Box object = bounding_box(prepared_.fine.level.mesh.nodes_m);
    MeshLoad load;
    load.name = name;
    load.applied = apply_load(is_sibling(name) ? sibling_load(name, object) : named_load(name, object),
                              mesh.level.mesh, mesh.is_held);
    return load;
}

void TunedScene::add_loads(PreparedMesh& mesh) const {
    for (std::size_t k = scene_loads_.size(); k < loads_.size(); ++k)
        mesh.loads.push_back(load_on(mesh, loads_[k]));
}

void TunedScene::add_mesh(const MeshSource& source, bool is_the_scenes, const std::string& name) {
    TunedMesh tuned;
    tuned.is_the_scenes = is_the_scenes;
    try {
        tuned.prepared = prepare_mesh(prepared_, make_mesh(source, read_), false, scene_loads_);
        add_loads(tuned.prepared);
    } catch (const ToolError& error) {
        notes_.push_back(fmt::format("mesh {}: left out: {}", name, error.what()));
        return;
    }
    tuned.prepared.source = source;
    const bool known = std::any_of(meshes_.begin(), meshes_.end(), [&](const TunedMesh& other) {
        return other.prepared.hash == tuned.prepared.hash;
    });
    if (known || tuned.prepared.hash == prepared_.fine.hash) return;
    if (tuned.tetrahedra() >= reference_tetrahedra()) {
        notes_.push_back(fmt::format("mesh {}: left out: not coarser than the fine mesh", name));
        return;
    }
    meshes_.push_back(std::move(tuned));
}

void TunedScene::add_meshes(const std::vector<std::string>& levels) {
    const Scene& scene = prepared_.scene;
    for (const Level& level : scene.levels)
        if (levels.empty() && level.mesh) add_mesh(*level.mesh, true, level.name);
    for (const std::string& level : levels)
        if (const auto source = level_source(scene, level)) {
            const bool its_own = std::any_of(scene.levels.begin(), scene.levels.end(),
                                             [&](const Level& known) { return known.mesh == source; });
            add_mesh(*source, its_own, level);
        }
    if (levels.empty())
        for (const MeshSource& source : coarser_meshes(scene.mesh, reference_tetrahedra()))
            add_mesh(source, false, text_of(source));
    std::stable_sort(meshes_.begin(), meshes_.end(),
                     [](const TunedMesh& a, const TunedMesh& b) { return a.tetrahedra() < b.tetrahedra(); });
    TunedMesh fine;
    fine.prepared = prepared_.fine;
    fine.prepared.source = scene.mesh;
    fine.is_fine = true;
    meshes_.push_back(std::move(fine));
}

std::uint64_t TunedScene::own_seed() const {
    return draws() ? prepared_.scene.material.seed : 1;
}

std::shared_ptr<const EvaluatedObject> TunedScene::object(std::uint64_t seed) const {
    const std::uint64_t key = draws() ? seed : 0;
    return objects_.get(key, [&] {
        EvaluatedObject made;
        made.fine.mesh = prepared_.fine.level.mesh;
        made.fine.material = make_scene_material(prepared_.scene, made.fine.mesh, seed, read_);
        made.hash = hash_of(prepared_.fine, made.fine.material);
        return made;
    });
}

std::shared_ptr<const StaticAnswer> TunedScene::reference(std::uint64_t seed, std::size_t load) const {
    return references_.get({draws() ? seed : 0, load}, [&] {
        return reference_answer(prepared_, *object(seed), load, ReferenceKind::fine, cache_);
    });
}

Material TunedScene::papers_material(const MaterialObject& fine, const PreparedMesh& mesh,
                                     const Recipe& recipe, std::uint64_t seed) const {
    const bool soft_first = recipe.order == BinOrder::soft_first;
    const std::string key =
        fmt::format("{} {} {} {}", seed, recipe.method.bins, recipe.method.clusters, soft_first);
    const auto aggregated = aggregated_.get(key, [&] {
        ClusterOptions options;
        options.bins = recipe.method.bins;
        options.clusters = recipe.method.clusters;
        options.seed = seed;
        const ClusterResult clustered = cluster_object(fine.mesh, fine.material, options);
        AggregateOptions aggregation;
        aggregation.order = recipe.order;
        return aggregate({fine.mesh, fine.material, clustered.clustering}, aggregation).material;
    });
    return coarsen({fine.mesh, *aggregated}, mesh.level.mesh, mesh.level.overlap, recipe.rule).material;
}

/// The most expensive of all methods: kept for the next run.
Material TunedScene::calibrated_material(const EvaluatedObject& object, const PreparedMesh& mesh) const {
    const std::string key = fmt::format("calibrated\n{}\n{}", object.hash, mesh.hash);
    Material material = mean_material(MethodKind::voigt, object.fine, mesh.level);
    std::vector<double>& moduli = material.youngs_modulus_pa;
    const auto kept = cache_.find(key);
    if (kept && kept->size() == moduli.size() * sizeof(double)) {
        std::copy(kept->begin(), kept->end(), reinterpret_cast<char*>(moduli.data()));
        return material;
    }
    moduli =
        calibrate(object.fine, prepared_.fine.is_held, mesh.level, mesh.is_held).material.youngs_modulus_pa;
    std::string bytes;
    append_bytes(bytes, moduli);
    cache_.keep(key, bytes);
    return material;
}

MadeLevel TunedScene::make_anew(std::size_t mesh, const Recipe& recipe, std::uint64_t seed) const {
    const auto from = object(seed);
    // Not owned: the meshes live as long as this does.
    const std::shared_ptr<const PreparedMesh> level(std::shared_ptr<void>(), &meshes_[mesh].prepared);
    if (recipe.kind == RecipeKind::fine) return {level, from->fine.material};
    if (recipe.kind == RecipeKind::mix) return {level, mixed(from->fine, level->level, recipe.reuss_percent)};
    switch (recipe.method.kind) {
        case MethodKind::paper:
            return {level, papers_material(from->fine, *level, recipe, seed)};
        case MethodKind::calibrated:
            return {level, calibrated_material(*from, *level)};
        case MethodKind::iycn13: {
            auto own = std::make_shared<PreparedMesh>(
                prepare_mesh(prepared_, region_adapted_mesh(from->fine, prepared_.scene.mesh, level->source),
                             false, scene_loads_));
            add_loads(*own);
            own->source = level->source;
            Material material = mean_material(MethodKind::voigt, from->fine, own->level);
            return {std::move(own), std::move(material)};
        }
        default:
            return {level, simple_material(recipe.method, from->fine, level->level, seed)};
    }
}

std::shared_ptr<const MadeLevel> TunedScene::make(std::size_t mesh, const Recipe& recipe,
                                                  std::uint64_t seed) const {
    const std::string key = fmt::format("{}\n{}\n{}", mesh, recipe.text(), seed);
    return made_.get(key, [&] { return make_anew(mesh, recipe, seed); });
}

LoadAnswer TunedScene::answer(std::size_t mesh, const Recipe& recipe, std::uint64_t seed,
                              std::size_t load) const {
    if (recipe.kind == RecipeKind::fine) return {true, {}, 0, 0};
    const std::string key = fmt::format(
        "tune\n{}\n{}\n{}\n{}\n{}\n{}", object(seed)->hash, meshes_[mesh].prepared.hash, recipe.text(),
        recipe.uses_seed() ? seed : 0, meshes_[mesh].prepared.loads[load].fingerprint(),
        prepared_.fine.loads[load].fingerprint());
    LoadAnswer result;
    if (const auto kept = cache_.find(key); kept && read_kept(*kept, read_answer, result)) return result;
    const auto wanted = reference(seed, load);
    const auto level = make(mesh, recipe, seed);
    const StaticAnswer found = solve(level->mesh->level.mesh, level->material, level->mesh->loads[load]);
    result.converged = wanted->converged && found.converged;
    result.problem = wanted->converged ? found.problem : wanted->problem;
    result.force_error = std::numeric_limits<double>::infinity();
    if (result.converged) {
        result.force_error = found.force_n / wanted->force_n - 1;
        result.displacement_error = displacement_error(*level->mesh, found, *wanted);
    }
    cache_.keep(key, to_cache(result));
    return result;
}

Asset TunedScene::asset(const MadeLevel& level) const {
    return bake_level(prepared_, {level.mesh->level.mesh, level.material});
}

std::vector<std::uint32_t> TunedScene::different_bins(const std::vector<std::uint32_t>& bins) const {
    const auto own = object(own_seed());
    std::vector<std::uint32_t> different;
    std::vector<std::vector<std::uint32_t>> seen;
    for (const std::uint32_t count : bins) {
        ClusterOptions options;
        options.bins = count;
        options.clusters = 1;
        std::vector<std::uint32_t> sorted =
            cluster_object(own->fine.mesh, own->fine.material, options).clustering.bin_of_tetrahedron;
        if (std::find(seen.begin(), seen.end(), sorted) != seen.end()) continue;
        seen.push_back(std::move(sorted));
        different.push_back(count);
    }
    return different;
}

StepTimes TunedScene::time(std::size_t mesh, const Recipe& recipe, int steps, int repeats) const {
    const auto level = make(mesh, recipe, own_seed());
    const Asset baked = asset(*level);
    const ToolPress press =
        tool_press(baked, 0, level->mesh->level.mesh, bounding_box(prepared_.fine.level.mesh.nodes_m));
    const PinnedThread pinned;
    StepTimes best = time_steps(baked, 0, press.direction, press.way_m, steps);
    for (int k = 1; k < repeats; ++k) {
        const StepTimes next = time_steps(baked, 0, press.direction, press.way_m, steps);
        best.p50_us = std::min(best.p50_us, next.p50_us);
        best.p99_us = std::min(best.p99_us, next.p99_us);
        best.p999_us = std::min(best.p999_us, next.p999_us);
        best.max_us = std::min(best.max_us, next.max_us);
        best.not_ok += next.not_ok;
    }
    return best;
}

double TunedScene::runtime_disagreement(std::size_t mesh, const Recipe& recipe) const {
    const auto level = make(mesh, recipe, own_seed());
    const MeshLoad& load = level->mesh->loads.front();  // the scene's first tool
    Asset baked = asset(*level);
    baked.gravity_m_per_s2 = {};  // the static answers know none
    const RuntimeRest rest = press_until_still(baked, 0, load.press->direction, load.press->way_m);
    const StaticAnswer wanted = solve(level->mesh->level.mesh, level->material, load);
    if (!wanted.converged)
        fail_result("the reference solver finds no rest under the scene's tool: " + wanted.problem);
    return std::abs(rest.force_n / wanted.force_n - 1);
}

}  // namespace knead::tools
