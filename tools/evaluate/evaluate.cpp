// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>

#include "common/error.h"
#include "evaluate/bytes.h"
#include "evaluate/cell.h"
#include "evaluate/pinned_thread.h"
#include "evaluate/prepared_scene.h"
#include "evaluate/runtime_cells.h"
#include "knead/formats/hash.h"

namespace knead::tools {
namespace {

/// A scene, its objects (one for each seed that gives another one) and its tasks.
struct SceneRun {
    PreparedScene prepared;
    std::map<std::uint64_t, std::unique_ptr<EvaluatedObject>> objects;  // by seed
    std::vector<CellTask> tasks;
    std::vector<std::vector<CellResult>> cells;      // [tasks][loads]
    std::vector<std::optional<CurveResult>> curves;  // [tasks]
    std::vector<SpeedResult> speed;
};

/// Counts what is done over all threads.
class Counter {
  public:
    Counter(const EvaluationListener& listener, std::size_t total) : listener_(listener), total_(total) {}
    void did(const std::string& what) {
        const std::lock_guard lock(mutex_);
        ++done_;
        if (listener_.progress) listener_.progress(done_, total_, what);
    }

  private:
    const EvaluationListener& listener_;
    std::mutex mutex_;
    std::size_t done_ = 0;
    std::size_t total_;
};

void make_objects(SceneRun& run, const EvaluationRequest& request, const FileReader& read) {
    const PreparedScene& prepared = run.prepared;
    const bool draws = draws_material(prepared.scene);
    for (std::uint32_t k = 0; k < (draws ? request.seeds : 1); ++k) {
        const std::uint64_t seed = request.seed_base + k;
        auto object = std::make_unique<EvaluatedObject>();
        object->fine.mesh = prepared.fine.level.mesh;
        object->fine.material = make_scene_material(prepared.scene, object->fine.mesh, seed, read);
        object->hash = hash_of(prepared.fine, object->fine.material);
        object->references.resize(prepared.reference.loads.size());
        run.objects.emplace(seed, std::move(object));
    }
}

/// In the order of the report: meshes, methods, seeds. A seed that changes nothing is left out.
void make_tasks(SceneRun& run, const EvaluationRequest& request) {
    for (const PreparedMesh& level : run.prepared.levels)
        for (const Method& method : request.methods)
            for (std::uint32_t k = 0; k < request.seeds; ++k) {
                const std::uint64_t seed = request.seed_base + k;
                const auto own = run.objects.find(seed);
                if (own == run.objects.end() && !method.uses_seed()) continue;
                const EvaluatedObject* object =
                    own == run.objects.end() ? run.objects.begin()->second.get() : own->second.get();
                run.tasks.push_back({&run.prepared, object, &level, method, seed});
            }
    run.cells.resize(run.tasks.size());
    run.curves.resize(run.tasks.size());
}

struct ReferenceTask {
    const PreparedScene* scene = nullptr;
    EvaluatedObject* object = nullptr;
    std::size_t load = 0;
};

std::vector<ReferenceTask> reference_tasks(const std::vector<std::unique_ptr<SceneRun>>& runs) {
    std::vector<ReferenceTask> tasks;
    for (const auto& run : runs)
        for (const auto& [seed, object] : run->objects)
            for (std::size_t load = 0; load < object->references.size(); ++load)
                tasks.push_back({&run->prepared, object.get(), load});
    return tasks;
}

struct TaskPlace {
    SceneRun* run = nullptr;
    std::size_t task = 0;
};

std::vector<TaskPlace> all_tasks(const std::vector<std::unique_ptr<SceneRun>>& runs) {
    std::vector<TaskPlace> places;
    for (const auto& run : runs)
        for (std::size_t k = 0; k < run->tasks.size(); ++k)
            places.push_back({run.get(), k});
    return places;
}

template <class Item, class Call>
void in_parallel(const std::vector<Item>& items, const Call& call) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, items.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t k = range.begin(); k < range.end(); ++k)
                call(items[k]);
        },
        tbb::simple_partitioner());
}

bool is_first_seed(const CellTask& task, const EvaluationRequest& request) {
    return task.seed == request.seed_base;
}

/// Steps are timed for the first seed, one asset after the other with nothing else running; the times do not
/// depend on the elasticities, so the other seeds get the same.
void time_all(const std::vector<TaskPlace>& places, const EvaluationRequest& request,
              const ResultCache& cache, Counter& counter) {
    const PinnedThread pinned;
    const CellResult* timed = nullptr;
    for (const TaskPlace& place : places) {
        const CellTask& task = place.run->tasks[place.task];
        std::vector<CellResult>& cells = place.run->cells[place.task];
        if (is_first_seed(task, request)) {
            time_cells(task, request.timed_steps, cache, cells);
            timed = &cells.front();
            counter.did(task.scene->scene.name + " " + task.method.text() + " time");
            continue;
        }
        for (CellResult& cell : cells) {
            cell.step = timed->step;
            cell.load_ms = timed->load_ms;
            cell.asset_bytes = timed->asset_bytes;
        }
    }
}

/// Runtime against plain baseline, for the first object: its raw elasticities on the fine mesh, and on each
/// coarser mesh the paper's method as the paper's Table 1 has it.
void time_baseline(SceneRun& run, const EvaluationRequest& request, const ResultCache& cache) {
    constexpr Method kRaw{MethodKind::raw_dominant, 0, 0};
    constexpr Method kPaper{MethodKind::paper, 2, 3};
    const PinnedThread pinned;
    const EvaluatedObject* object = run.objects.begin()->second.get();
    const auto time = [&](const PreparedMesh& mesh, const Method& method, const std::string& name) {
        const CellTask task{&run.prepared, object, &mesh, method, request.seed_base};
        if (auto speed = time_speed(task, name, request.timed_steps, cache))
            run.speed.push_back(*std::move(speed));
    };
    time(run.prepared.fine, kRaw, "reference");
    for (const PreparedMesh& level : run.prepared.levels)
        if (level.level.mesh.tetrahedra.size() < run.prepared.fine.level.mesh.tetrahedra.size())
            time(level, kPaper, name_of(kPaper.kind));
}

/// The states of the first object, by the first of the paper's methods asked for, on the coarsest mesh.
void add_states(const SceneRun& run, const EvaluationRequest& request, SceneResult& result) {
    Method method{MethodKind::paper, 2, 3};
    for (std::size_t k = request.methods.size(); k-- > 0;)
        if (request.methods[k].kind == MethodKind::paper) method = request.methods[k];
    const MaterialObject& fine = run.objects.begin()->second->fine;
    result.states = fine_states(fine, method.bins, method.clusters, request.seed_base);
    const PreparedMesh& coarsest =
        *std::min_element(run.prepared.levels.begin(), run.prepared.levels.end(),
                          [](const PreparedMesh& a, const PreparedMesh& b) {
                              return a.level.mesh.tetrahedra.size() < b.level.mesh.tetrahedra.size();
                          });
    const MaterialObject coarse{coarsest.level.mesh,
                                simple_material(method, fine, coarsest.level, request.seed_base)};
    result.asset = groups_in_asset(run.prepared, coarse);
    result.states.push_back({"C5 coarse", coarse, {}});
}

void note_once(SceneResult& result, const std::string& note) {
    if (std::find(result.notes.begin(), result.notes.end(), note) == result.notes.end())
        result.notes.push_back(note);
}

SceneResult result_of(SceneRun& run, const EvaluationRequest& request, const ResultCache& cache) {
    SceneResult result;
    result.name = run.prepared.scene.name;
    result.reference_tetrahedra = run.prepared.reference.level.mesh.tetrahedra.size();
    result.reference = request.reference;
    result.notes = run.prepared.notes;
    if (request.with_states) add_states(run, request, result);
    if (request.with_curves)
        if (auto curve =
                reference_curve(run.prepared, *run.objects.begin()->second, request.seed_base, cache))
            result.curves.push_back(*std::move(curve));
    for (std::size_t load = 0; load < run.prepared.fine.loads.size(); ++load)
        for (const std::vector<CellResult>& cells : run.cells) {
            const CellResult& cell = cells[load];
            if (cell.applicable)
                result.cells.push_back(cell);
            else
                note_once(result, cell.problem + " (" + cell.load + " left out)");
        }
    for (std::optional<CurveResult>& curve : run.curves)
        if (curve) result.curves.push_back(std::move(*curve));
    result.speed = std::move(run.speed);
    return result;
}

}  // namespace

const char* name_of(ReferenceKind kind) {
    return kind == ReferenceKind::fine ? "fine" : "finer";
}

std::vector<SceneResult> evaluate(const EvaluationRequest& request, const ResultCache& cache,
                                  const FileReader& read, const EvaluationListener& listener) {
    if (request.seeds == 0) fail_usage("zero seeds: nothing would be evaluated");
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, request.threads);
    std::vector<std::unique_ptr<SceneRun>> runs;
    for (const auto& file : request.scenes) {
        auto run = std::make_unique<SceneRun>();
        run->prepared = prepare(file, request, read);
        make_objects(*run, request, read);
        make_tasks(*run, request);
        runs.push_back(std::move(run));
    }
    const std::vector<ReferenceTask> references = reference_tasks(runs);
    const std::vector<TaskPlace> places = all_tasks(runs);
    std::size_t total = references.size() + places.size();
    if (request.timed_steps > 0)
        for (const TaskPlace& place : places)
            total += is_first_seed(place.run->tasks[place.task], request) ? 1 : 0;
    if (request.timed_steps > 0 && request.with_baseline) total += runs.size();
    Counter counter(listener, total);
    in_parallel(references, [&](const ReferenceTask& task) {
        task.object->references[task.load] =
            reference_answer(*task.scene, *task.object, task.load, request.reference, cache);
        counter.did(task.scene->scene.name + " reference");
    });
    in_parallel(places, [&](const TaskPlace& place) {
        const CellTask& task = place.run->tasks[place.task];
        place.run->cells[place.task] = evaluate_cells(task, request.reference, cache);
        if (request.with_curves && is_first_seed(task, request))
            place.run->curves[place.task] = evaluate_curve(task, cache);
        counter.did(task.scene->scene.name + " " + task.method.text());
    });
    if (request.timed_steps > 0) {
        time_all(places, request, cache, counter);
        for (const auto& run : runs) {
            if (!request.with_baseline) break;
            time_baseline(*run, request, cache);
            counter.did(run->prepared.scene.name + " baseline");
        }
    }
    std::vector<SceneResult> results;
    for (const auto& run : runs)
        results.push_back(result_of(*run, request, cache));
    return results;
}

}  // namespace knead::tools
