// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/runtime_cells.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cmath>
#include <system_error>

#include "common/error.h"
#include "evaluate/cell_json.h"
#include "evaluate/scene_tool.h"
#include "knead/formats/hash.h"
#include "knead/formats/write/write.h"
#include "knead/runtime/step_result.h"

namespace knead::tools {
namespace {

constexpr int kLoadRepetitions = 5;

/// An asset with the load as its only tool, the direction and the way of the press.
struct RuntimePress {
    Asset asset;
    Point direction{};
    double way_m = 0;
};

RuntimePress runtime_press(const PreparedScene& scene, const PreparedMesh& mesh, const Material& material,
                           const MeshLoad& load) {
    RuntimePress press;
    press.asset = bake_level(scene, {mesh.level.mesh, material});
    press.asset.gravity_m_per_s2 = {};  // the static references know none
    if (load.press) {
        std::vector<ToolSet> tools;
        for (const ToolSet& tool : press.asset.tools)
            if (tool.name == load.press->tool.name) tools.push_back(tool);
        press.asset.tools = tools;
        press.direction = load.press->direction;
        press.way_m = load.press->way_m;
        return press;
    }
    replace_tools(press.asset, load.applied, mesh.level.mesh);
    const Point& shift = load.applied.motion.displacement_m.back();
    press.way_m = std::hypot(shift[0], shift[1], shift[2]);
    for (std::size_t axis = 0; axis < 3; ++axis)
        press.direction[axis] = shift[axis] / press.way_m;
    return press;
}

/// A folder of its own that goes away again.
class ScratchFolder {
  public:
    ScratchFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "knead-evaluate-XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr)
            throw ToolError(ExitCode::cannot_write, pattern + ": cannot make a temporary folder");
        folder_ = pattern;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] std::filesystem::path file(const char* name) const { return folder_ / name; }

  private:
    std::filesystem::path folder_;
};

/// An asset as a file for as long as it is needed.
class AssetFile {
  public:
    explicit AssetFile(const Asset& asset) : path_(scratch_.file("asset.hdf")) {
        value_or_throw(write_asset(path_, asset, {}));
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::string hash() const { return value_or_throw(sha256_of_file(path_)); }

  private:
    ScratchFolder scratch_;
    std::filesystem::path path_;
};

ForceCurve kept_curve(const RuntimePress& press, const ResultCache& cache) {
    const std::string key =
        fmt::format("curve\n{}\n{}\n{}\n{}\n{}", AssetFile(press.asset).hash(), press.direction[0],
                    press.direction[1], press.direction[2], press.way_m);
    ForceCurve curve;
    if (const auto kept = cache.find(key); kept && curve_from_cache(*kept, curve)) return curve;
    curve = press_curve(press.asset, 0, press.direction, press.way_m);
    cache.keep(key, curve_to_cache(curve));
    return curve;
}

std::optional<CurveResult> curve_of(const PreparedScene& scene, const PreparedMesh& mesh,
                                    const Material& material, const Method& method, std::uint64_t seed,
                                    const ResultCache& cache) {
    for (const MeshLoad& load : mesh.loads) {
        if (!runtime_knows(load)) continue;
        return CurveResult{name_of(method.kind),
                           method.bins,
                           method.clusters,
                           mesh.level.mesh.tetrahedra.size(),
                           seed,
                           load.name,
                           kept_curve(runtime_press(scene, mesh, material, load), cache)};
    }
    return std::nullopt;
}

/// What steps are timed under: the scene's first tool, pressed.
ToolPress timed_press(const CellTask& task, const Asset& asset, const PreparedMesh& mesh) {
    return tool_press(asset, 0, mesh.level.mesh, bounding_box(task.scene->fine.level.mesh.nodes_m));
}

}  // namespace

bool runtime_knows(const MeshLoad& load) {
    if (load.press) return true;
    return load.name == "press10" && load.applied.motion.ties.empty();
}

void ask_runtime(const PreparedScene& scene, const CoarseObject& coarse, const MeshLoad& load,
                 CellResult& cell) {
    const RuntimePress press = runtime_press(scene, *coarse.mesh, coarse.material, load);
    const RuntimeRest rest = press_until_still(press.asset, 0, press.direction, press.way_m);
    cell.runtime_force_n = rest.force_n;
    if (!rest.is_still) cell.problem = "the runtime does not come to rest";
    if (!is_solved(rest.status)) cell.problem = fmt::format("the runtime's step status is {}", rest.status);
}

std::optional<CurveResult> evaluate_curve(const CellTask& task, const ResultCache& cache) {
    const CoarseObject coarse = make_coarse_object(task);
    if (!coarse.runs_in_the_runtime()) return std::nullopt;
    return curve_of(*task.scene, *coarse.mesh, coarse.material, task.method, task.seed, cache);
}

std::optional<CurveResult> reference_curve(const PreparedScene& scene, const EvaluatedObject& object,
                                           std::uint64_t seed, const ResultCache& cache) {
    auto curve =
        curve_of(scene, scene.fine, object.fine.material, {MethodKind::raw_dominant, 0, 0}, seed, cache);
    if (curve) curve->method = "reference";
    return curve;
}

void time_cells(const CellTask& task, int steps, const ResultCache& cache, std::vector<CellResult>& cells) {
    const CoarseObject coarse = make_coarse_object(task);
    if (!coarse.runs_in_the_runtime()) return;
    const Asset asset = bake_level(*task.scene, {coarse.mesh->level.mesh, coarse.material});
    const AssetFile file(asset);
    const std::string key = fmt::format("times\n{}\n{}", file.hash(), steps);
    CellResult timed;
    const auto kept = cache.find(key);
    if (!kept || !times_from_cache(*kept, timed)) {
        const ToolPress press = timed_press(task, asset, *coarse.mesh);
        timed.asset_bytes = std::filesystem::file_size(file.path());
        timed.load_ms = time_load_ms(file.path(), kLoadRepetitions);
        timed.step = time_steps(asset, 0, press.direction, press.way_m, steps);
        cache.keep(key, times_to_cache(timed));
    }
    for (CellResult& cell : cells) {
        cell.asset_bytes = timed.asset_bytes;
        cell.load_ms = timed.load_ms;
        cell.step = timed.step;
    }
}

std::optional<SpeedResult> time_speed(const CellTask& task, const std::string& method, int steps,
                                      const ResultCache& cache) {
    const CoarseObject coarse = make_coarse_object(task);
    const Asset asset = bake_level(*task.scene, {coarse.mesh->level.mesh, coarse.material});
    if (asset.tools.front().contact != ToolContact::bonded) return std::nullopt;
    SpeedResult result{method, task.method.bins, task.method.clusters, asset.tetrahedra.size(), {}};
    const std::string key = fmt::format("speed\n{}\n{}", AssetFile(asset).hash(), steps);
    if (const auto kept = cache.find(key); kept && speed_from_cache(*kept, result.times)) return result;
    const ToolPress press = timed_press(task, asset, *coarse.mesh);
    result.times = time_in_turns(asset, press.direction, press.way_m, steps);
    cache.keep(key, speed_to_cache(result.times));
    return result;
}

std::vector<AssetGroup> groups_in_asset(const PreparedScene& scene, const MaterialObject& object) {
    const Asset asset = bake_level(scene, object);
    return asset_groups(asset, AssetFile(asset).path());
}

}  // namespace knead::tools
