// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/cell.h"

#include <fmt/format.h>

#include <cmath>

#include "evaluate/calibration.h"
#include "evaluate/cell_json.h"
#include "evaluate/numerical_coarsening.h"
#include "evaluate/region_adapted.h"
#include "evaluate/runtime_cells.h"

namespace knead::tools {
namespace {

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
    if (coarse.runs_in_the_runtime() && runtime_knows(mesh_load))
        ask_runtime(*task.scene, coarse, mesh_load, cell);
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

}  // namespace knead::tools
