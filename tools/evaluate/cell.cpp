// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/cell.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cmath>
#include <system_error>

#include "common/error.h"
#include "evaluate/calibration.h"
#include "evaluate/cell_json.h"
#include "evaluate/numerical_coarsening.h"
#include "evaluate/region_adapted.h"
#include "knead/formats/hash.h"
#include "knead/formats/write/write.h"
#include "knead/runtime/step_result.h"

namespace knead::tools {
namespace {

constexpr int kLoadRepetitions = 5;

double root_sum(const std::vector<Point>& values) {
    double sum = 0;
    for (const Point& value : values)
        for (const double x : value)
            sum += x * x;
    return std::sqrt(sum);
}

/// Over the surface nodes of the level: |u - u_reference| / |u_reference|, root mean squares.
double displacement_error(const PreparedMesh& mesh, const StaticAnswer& answer,
                          const StaticAnswer& reference) {
    const std::vector<Point> wanted = values_at(mesh.places, reference.displacement_m);
    std::vector<Point> difference = wanted;
    for (std::size_t k = 0; k < wanted.size(); ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            difference[k][axis] -= answer.displacement_m[mesh.outer[k]][axis];
    return root_sum(difference) / root_sum(wanted);
}

/// The runtime can be asked for the scene's tools, and for the press as long as its nodes are simply those of
/// a tool.
bool runtime_knows(const MeshLoad& load) {
    if (load.press) return true;
    return load.name == "press10" && load.applied.motion.ties.empty();
}

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
    press.way_m = root_sum({shift});
    for (std::size_t axis = 0; axis < 3; ++axis)
        press.direction[axis] = shift[axis] / press.way_m;
    return press;
}

void ask_runtime(const CellTask& task, const CoarseObject& coarse, const MeshLoad& load, CellResult& cell) {
    const RuntimePress press = runtime_press(*task.scene, *coarse.mesh, coarse.material, load);
    const RuntimeRest rest = press_until_still(press.asset, 0, press.direction, press.way_m);
    cell.runtime_force_n = rest.force_n;
    if (!rest.is_still) cell.problem = "the runtime does not come to rest";
    if (rest.status != kStepOk) cell.problem = fmt::format("the runtime's step status is {}", rest.status);
}

/// Calibration saw the loads that move the whole upper surface rigidly, whoever does it.
bool is_fitted(const CellTask& task, const MeshLoad& load) {
    if (task.method.kind != MethodKind::calibrated) return false;
    if (!load.press || load.in_contact()) return is_probed(load.name);
    const TetMesh& mesh = task.level->level.mesh;
    const Box object = bounding_box(task.scene->fine.level.mesh.nodes_m);
    const AppliedLoad press = apply_load(named_load("press10", object), mesh, task.level->is_held);
    return press.motion.nodes == load.applied.motion.nodes;
}

std::string cell_key(const CellTask& task, std::size_t load, ReferenceKind kind) {
    return fmt::format("cell\n{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", task.object->hash, task.level->hash,
                       task.method.text(), task.method.uses_seed() ? task.seed : 0,
                       task.level->loads[load].fingerprint(), task.scene->reference.loads[load].fingerprint(),
                       name_of(kind), task.scene->reference.hash);
}

CellResult evaluate_cell(const CellTask& task, const CoarseObject& coarse, std::size_t load) {
    CellResult cell;
    const MeshLoad& mesh_load = coarse.mesh->loads[load];
    cell.tetrahedra = coarse.mesh->level.mesh.tetrahedra.size();
    const StaticAnswer& reference = task.object->references[load];
    cell.reference_force_n = reference.force_n;
    cell.fitted = is_fitted(task, mesh_load);
    if (!coarse.tensors.empty() && mesh_load.in_contact())
        cell.problem = "kmod09 is not solved under a tool that touches and leaves";
    if (!coarse.problem.empty()) cell.problem = coarse.problem;
    cell.applicable = cell.problem.empty();
    if (!cell.applicable) return cell;
    const StaticAnswer answer = solve(coarse.mesh->level.mesh, coarse.material, mesh_load, coarse.tensors);
    cell.converged = answer.converged && reference.converged;
    cell.problem = answer.converged ? reference.problem : answer.problem;
    if (!cell.converged) return cell;
    cell.force_n = answer.force_n;
    cell.force_error = answer.force_n / reference.force_n - 1;
    cell.displacement_error = displacement_error(*coarse.mesh, answer, reference);
    if (coarse.runs_in_the_runtime() && runtime_knows(mesh_load)) ask_runtime(task, coarse, mesh_load, cell);
    return cell;
}

void make_coarsened_tensors(const CellTask& task, CoarseObject& coarse) {
    coarse.material = mean_material(MethodKind::voigt, task.object->fine, task.level->level);
    coarse.tensors = coarsen_numerically(task.object->fine, task.level->level).tensors;
}

void make_region_adapted(const CellTask& task, CoarseObject& coarse) {
    const MeshSource& fine = task.scene->scene.mesh;
    if (fine.kind != "cubes") {
        coarse.problem = "iycn13 moves the planes of a mesh of cubes; this object has none";
        return;
    }
    std::vector<std::string> loads;
    for (const MeshLoad& load : task.level->loads)
        loads.push_back(load.name);
    TetMesh mesh = region_adapted_mesh(task.object->fine, fine, task.level->source);
    coarse.own_mesh =
        std::make_shared<PreparedMesh>(prepare_mesh(*task.scene, std::move(mesh), false, loads));
    coarse.mesh = coarse.own_mesh.get();
    coarse.material = mean_material(MethodKind::voigt, task.object->fine, coarse.mesh->level);
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

/// Force over time of the first load that the runtime can do.
std::optional<CurveResult> curve_of(const PreparedScene& scene, const PreparedMesh& mesh,
                                    const Material& material, const Method& method, std::uint64_t seed) {
    for (const MeshLoad& load : mesh.loads) {
        if (!runtime_knows(load)) continue;
        const RuntimePress press = runtime_press(scene, mesh, material, load);
        return CurveResult{name_of(method.kind),
                           method.bins,
                           method.clusters,
                           mesh.level.mesh.tetrahedra.size(),
                           seed,
                           load.name,
                           press_curve(press.asset, 0, press.direction, press.way_m)};
    }
    return std::nullopt;
}

/// What steps are timed under: the scene's first tool, pressed.
ToolPress timed_press(const CellTask& task, const Asset& asset, const PreparedMesh& mesh) {
    return tool_press(asset, 0, mesh.level.mesh, bounding_box(task.scene->fine.level.mesh.nodes_m));
}

}  // namespace

bool CellResult::within_jnd() const {
    return converged && std::abs(force_error) <= kJndOfForce;
}

double CellResult::runtime_disagreement() const {
    return runtime_force_n ? std::abs(*runtime_force_n / force_n - 1) : 0;
}

CoarseObject make_coarse_object(const CellTask& task) {
    CoarseObject coarse;
    coarse.mesh = task.level;
    switch (task.method.kind) {
        case MethodKind::kmod09:
            make_coarsened_tensors(task, coarse);
            break;
        case MethodKind::iycn13:
            make_region_adapted(task, coarse);
            break;
        case MethodKind::calibrated:
            coarse.material =
                calibrate(task.object->fine, task.scene->fine.is_held, task.level->level, task.level->is_held)
                    .material;
            break;
        default:
            coarse.material = simple_material(task.method, task.object->fine, task.level->level, task.seed);
    }
    return coarse;
}

StaticAnswer reference_answer(const PreparedScene& scene, const EvaluatedObject& object, std::size_t load,
                              ReferenceKind kind, const ResultCache& cache) {
    const MeshLoad& mesh_load = scene.reference.loads[load];
    const std::string key = fmt::format("reference\n{}\n{}\n{}\n{}", object.hash, name_of(kind),
                                        scene.reference.hash, mesh_load.fingerprint());
    if (const auto kept = cache.find(key))
        if (auto answer = answer_of(*kept)) return *std::move(answer);
    StaticAnswer answer;
    if (kind == ReferenceKind::finer) {
        const MaterialObject split = split_in_eight(object.fine);
        answer = solve(split.mesh, split.material, mesh_load);
    } else {
        answer = solve(object.fine.mesh, object.fine.material, mesh_load);
    }
    cache.keep(key, to_bytes(answer));
    return answer;
}

std::vector<CellResult> evaluate_cells(const CellTask& task, ReferenceKind kind, const ResultCache& cache) {
    std::vector<CellResult> cells;
    std::optional<CoarseObject> coarse;
    for (std::size_t load = 0; load < task.level->loads.size(); ++load) {
        const std::string key = cell_key(task, load, kind);
        CellResult cell;
        const auto kept = cache.find(key);
        if (!kept || !from_cache(*kept, cell)) {
            if (!coarse) coarse = make_coarse_object(task);
            cell = evaluate_cell(task, *coarse, load);
            cache.keep(key, to_cache(cell));
        }
        cell.method = task.method;
        cell.seed = task.seed;
        cell.load = task.level->loads[load].name;
        cells.push_back(std::move(cell));
    }
    return cells;
}

std::optional<CurveResult> evaluate_curve(const CellTask& task) {
    const CoarseObject coarse = make_coarse_object(task);
    if (!coarse.runs_in_the_runtime()) return std::nullopt;
    return curve_of(*task.scene, *coarse.mesh, coarse.material, task.method, task.seed);
}

std::optional<CurveResult> reference_curve(const PreparedScene& scene, const EvaluatedObject& object,
                                           std::uint64_t seed) {
    auto curve = curve_of(scene, scene.fine, object.fine.material, {MethodKind::raw_dominant, 0, 0}, seed);
    if (curve) curve->method = "reference";
    return curve;
}

std::vector<AssetGroup> groups_in_asset(const PreparedScene& scene, const MaterialObject& object) {
    const Asset asset = bake_level(scene, object);
    const ScratchFolder scratch;
    const auto file = scratch.file("asset.hdf");
    value_or_throw(write_asset(file, asset, {}));
    return asset_groups(asset, file);
}

void time_cells(const CellTask& task, int steps, const ResultCache& cache, std::vector<CellResult>& cells) {
    const CoarseObject coarse = make_coarse_object(task);
    if (!coarse.runs_in_the_runtime()) return;
    const Asset asset = bake_level(*task.scene, {coarse.mesh->level.mesh, coarse.material});
    const ScratchFolder scratch;
    const auto file = scratch.file("asset.hdf");
    value_or_throw(write_asset(file, asset, {}));
    const std::string key = fmt::format("times\n{}\n{}", value_or_throw(sha256_of_file(file)), steps);
    CellResult timed;
    const auto kept = cache.find(key);
    if (!kept || !times_from_cache(*kept, timed)) {
        const ToolPress press = timed_press(task, asset, *coarse.mesh);
        timed.asset_bytes = std::filesystem::file_size(file);
        timed.load_ms = time_load_ms(file, kLoadRepetitions);
        timed.step = time_steps(asset, 0, press.direction, press.way_m, steps);
        cache.keep(key, times_to_cache(timed));
    }
    for (CellResult& cell : cells) {
        cell.asset_bytes = timed.asset_bytes;
        cell.load_ms = timed.load_ms;
        cell.step = timed.step;
    }
}

}  // namespace knead::tools
