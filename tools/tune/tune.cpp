// SPDX-License-Identifier: GPL-3.0-or-later
#include "tune/tune.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "common/error.h"
#include "evaluate/calibration.h"
#include "tune/mesh_range.h"
#include "tune/tune_loads.h"

namespace knead::tools {
namespace {

constexpr std::uint32_t kPapersClusters[] = {1, 3, 6};

std::vector<std::string> held_out_of(const TuneRequest& request) {
    return request.held_out ? *request.held_out : siblings_of(request.on);
}

/// One run of the tool on one scene.
class Tuning {
  public:
    Tuning(const TunedScene& scene, const TuneRequest& request,
           const std::function<void(std::string_view)>& tell)
        : scene_(scene), tell_(tell) {
        result_.name = scene.scene().name;
        result_.request = request;
        result_.reference_tetrahedra = scene.reference_tetrahedra();
        result_.loads = scene.loads();
        result_.notes = scene.notes();
        result_.seeds_draw_material = scene.draws();
        result_.chosen_loads = numbers_of(hardest_first(request.on));
        result_.proven_loads = numbers_of(request.on);
        for (const std::size_t load : numbers_of(held_out_of(request)))
            result_.proven_loads.push_back(load);
        for (std::uint32_t k = 0; k < request.choosing_seeds; ++k)
            result_.choosing_seeds.push_back(scene.own_seed() + k);
    }

    TuneResult run() {
        const auto from = std::chrono::steady_clock::now();
        time_meshes();
        list_candidates();
        result_.outcome = search(search_space());
        if (result_.outcome.found)
            gather(result_.outcome.found->candidate, result_.outcome.found->first_seed);
        else if (result_.outcome.nearest_in_time)
            gather(result_.outcome.nearest_in_time->candidate, first_unused_seed());
        result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
        return std::move(result_);
    }

  private:
    /// Those that the object has a place for.
    [[nodiscard]] std::vector<std::size_t> numbers_of(const std::vector<std::string>& names) const {
        std::vector<std::size_t> numbers;
        for (const std::string& name : names) {
            const auto at = std::find(result_.loads.begin(), result_.loads.end(), name);
            if (at != result_.loads.end())
                numbers.push_back(static_cast<std::size_t>(at - result_.loads.begin()));
        }
        return numbers;
    }

    [[nodiscard]] static bool is_in(const std::vector<std::size_t>& numbers, std::size_t number) {
        return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
    }

    [[nodiscard]] StepTimes time(std::size_t mesh, const Recipe& recipe) const {
        return scene_.time(mesh, recipe, result_.request.steps, result_.request.repeats);
    }

    [[nodiscard]] double budgeted_us(const StepTimes& step) const {
        return result_.request.budget_is_p50 ? step.p50_us : step.p99_us;
    }

    /// A step's time depends on the mesh, hardly on the elasticities: one level of each is timed.
    void time_meshes() {
        Recipe fine;
        fine.kind = RecipeKind::fine;
        Recipe voigt;
        voigt.method = {MethodKind::voigt, 0, 0};
        for (std::size_t k = 0; k < scene_.meshes().size(); ++k) {
            const TunedMesh& mesh = scene_.meshes()[k];
            result_.meshes.push_back({mesh.tetrahedra(), mesh.is_fine, mesh.is_the_scenes,
                                      time(k, mesh.is_fine ? fine : voigt), text_of(mesh.prepared.source)});
            tell(fmt::format("{} tetrahedra: a step takes {:.0f} us, 99 % at most {:.0f} us",
                             mesh.tetrahedra(), result_.meshes.back().step.p50_us,
                             result_.meshes.back().step.p99_us));
        }
    }

    void list_candidates() {
        RecipeChoice choice = result_.request.choice;
        choice.bins = scene_.different_bins(choice.bins);
        if (choice.bins.size() < result_.request.choice.bins.size())
            result_.notes.push_back(
                fmt::format("only these numbers of bins differ: {}", fmt::join(choice.bins, ", ")));
        const bool with_fine =
            std::find(choice.methods.begin(), choice.methods.end(), "fine") != choice.methods.end();
        for (std::size_t mesh = 0; mesh < result_.meshes.size(); ++mesh) {
            if (result_.meshes[mesh].is_fine) {
                Recipe fine;
                fine.kind = RecipeKind::fine;
                if (with_fine) result_.candidates.push_back({mesh, fine});
                continue;
            }
            for (const Recipe& recipe : recipes_of(choice))
                if (recipe.method.kind != MethodKind::iycn13 || recipe.kind != RecipeKind::method ||
                    scene_.scene().mesh.kind == "cubes")
                    result_.candidates.push_back({mesh, recipe});
        }
    }

    [[nodiscard]] SearchSpace search_space() const {
        SearchSpace space;
        const TuneRequest& request = result_.request;
        space.within = request.within;
        space.budget_us = request.budget_us;
        space.choosing_seeds = result_.choosing_seeds;
        space.fresh_seeds = request.fresh_seeds;
        space.chosen_loads = result_.chosen_loads;
        space.proven_loads = result_.proven_loads;
        for (const TuneMesh& mesh : result_.meshes)
            space.meshes.push_back({budgeted_us(mesh.step), {}, mesh.is_fine});
        for (std::size_t k = 0; k < result_.candidates.size(); ++k)
            space.meshes[result_.candidates[k].mesh].candidates.push_back(k);
        space.error = [this](std::size_t candidate, std::uint64_t seed, std::size_t load) {
            const TuneCandidate& asked = result_.candidates[candidate];
            return scene_.answer(asked.mesh, asked.recipe, seed, load).force_error;
        };
        space.step_us = [this](std::size_t candidate) {
            const TuneCandidate& asked = result_.candidates[candidate];
            return budgeted_us(time(asked.mesh, asked.recipe));
        };
        space.depends_on_seed = [this](std::size_t candidate) {
            return scene_.draws() || result_.candidates[candidate].recipe.uses_seed();
        };
        space.tell = tell_;
        return space;
    }

    [[nodiscard]] std::uint64_t first_unused_seed() const {
        std::uint64_t next = result_.choosing_seeds.back() + 1;
        for (const Look& look : result_.outcome.looks)
            next = std::max(next, look.first_seed + result_.request.fresh_seeds);
        return next;
    }

    /// How a level does on all loads and on seeds that it was not chosen on, and the paper's beside it.
    void gather(std::size_t candidate, std::uint64_t first_seed) {
        const TuneCandidate& level = result_.candidates[candidate];
        LevelEvidence evidence;
        evidence.candidate = candidate;
        const bool seeds_matter = scene_.draws() || level.recipe.uses_seed();
        if (level.recipe.kind == RecipeKind::fine) first_seed = result_.choosing_seeds.back() + 1;
        evidence.first_seed = seeds_matter ? first_seed : result_.choosing_seeds.front();
        evidence.seeds = seeds_matter ? result_.request.fresh_seeds : 1;
        evidence.step = time(level.mesh, level.recipe);
        evidence.runtime_disagreement = scene_.runtime_disagreement(level.mesh, level.recipe);
        if (evidence.runtime_disagreement > kRuntimeAgreement)
            fail_result(fmt::format("{}: the runtime and the reference solver differ by {:.2g} on {}",
                                    result_.name, evidence.runtime_disagreement, level.recipe.text()));
        const auto answers = answers_of(level, evidence.first_seed, evidence.seeds);
        for (std::size_t load = 0; load < result_.loads.size(); ++load)
            if (is_asked_for(load))
                evidence.loads.push_back(evidence_of(level, load, answers, evidence.first_seed));
        gather_papers(level.mesh, evidence);
        result_.evidence = std::move(evidence);
    }

    /// The scene's own tool is prepared for the runtime's check in any case, and shown only when asked for.
    [[nodiscard]] bool is_asked_for(std::size_t load) const {
        return result_.loads[load] != "scene" || is_in(result_.proven_loads, load);
    }

    /// [seeds][loads]
    [[nodiscard]] std::vector<std::vector<LoadAnswer>> answers_of(const TuneCandidate& level,
                                                                  std::uint64_t first_seed,
                                                                  std::uint32_t seeds) const {
        std::vector<std::vector<LoadAnswer>> answers(seeds, std::vector<LoadAnswer>(result_.loads.size()));
        tbb::parallel_for(std::uint32_t{0}, seeds, [&](std::uint32_t k) {
            for (std::size_t load = 0; load < result_.loads.size(); ++load)
                if (is_asked_for(load))
                    answers[k][load] = scene_.answer(level.mesh, level.recipe, first_seed + k, load);
        });
        return answers;
    }

    [[nodiscard]] LoadEvidence evidence_of(const TuneCandidate& level, std::size_t load,
                                           const std::vector<std::vector<LoadAnswer>>& answers,
                                           std::uint64_t first_seed) const {
        LoadEvidence evidence;
        evidence.load = result_.loads[load];
        evidence.is_claimed = is_in(result_.proven_loads, load);
        evidence.was_chosen_on = is_in(result_.chosen_loads, load);
        evidence.was_fitted = level.recipe.method.kind == MethodKind::calibrated && is_probed(evidence.load);
        evidence.seeds = answers.size();
        std::size_t converged = 0;
        Worst worst;
        for (std::size_t k = 0; k < answers.size(); ++k) {
            const LoadAnswer& answer = answers[k][load];
            worst.add(answer.force_error, load, first_seed + k);
            if (!(std::abs(answer.force_error) <= result_.request.within)) ++evidence.beyond;
            if (!answer.converged) continue;
            ++converged;
            evidence.mean += answer.force_error;
            evidence.displacement_error += answer.displacement_error;
        }
        evidence.mean /= static_cast<double>(std::max<std::size_t>(converged, 1));
        evidence.displacement_error /= static_cast<double>(std::max<std::size_t>(converged, 1));
        evidence.worst = worst.error;
        evidence.worst_seed = worst.seed;
        return evidence;
    }

    /// On the answer's mesh and on those of the scene's own levels that are in time.
    void gather_papers(std::size_t mesh, const LevelEvidence& evidence) {
        for (std::size_t m = 0; m < result_.meshes.size(); ++m) {
            const TuneMesh& candidate = result_.meshes[m];
            const bool wanted = m == mesh || (candidate.is_the_scenes &&
                                              budgeted_us(candidate.step) <= result_.request.budget_us);
            if (!wanted || candidate.is_fine) continue;
            for (const std::uint32_t clusters : kPapersClusters)
                result_.papers.push_back(paper_evidence(m, clusters, evidence));
        }
    }

    [[nodiscard]] PaperEvidence paper_evidence(std::size_t mesh, std::uint32_t clusters,
                                               const LevelEvidence& beside) const {
        PaperEvidence evidence;
        evidence.mesh = mesh;
        evidence.clusters = clusters;
        // Without drawn materials the paper's own seed is that of k-means alone.
        const std::uint64_t first = beside.seeds > 1 ? beside.first_seed : first_unused_seed();
        const std::uint32_t seeds = result_.request.fresh_seeds;
        std::vector<double> errors(seeds * result_.proven_loads.size());
        tbb::parallel_for(std::size_t{0}, errors.size(), [&](std::size_t k) {
            const std::size_t load = result_.proven_loads[k % result_.proven_loads.size()];
            errors[k] =
                scene_.answer(mesh, papers_recipe(clusters), first + k / result_.proven_loads.size(), load)
                    .force_error;
        });
        for (std::size_t k = 0; k < errors.size(); ++k) {
            evidence.worst.add(errors[k], result_.proven_loads[k % result_.proven_loads.size()],
                               first + k / result_.proven_loads.size());
            evidence.beyond += std::abs(errors[k]) <= result_.request.within ? 0 : 1;
        }
        evidence.answers = errors.size();
        return evidence;
    }

    void tell(const std::string& text) const {
        if (tell_) tell_(text);
    }

    const TunedScene& scene_;
    const std::function<void(std::string_view)>& tell_;
    TuneResult result_;
};

}  // namespace

TuneResult tune(const TunedScene& scene, const TuneRequest& request,
                const std::function<void(std::string_view)>& tell) {
    return Tuning(scene, request, tell).run();
}

LoadNames load_names(const TuneRequest& request) {
    LoadNames names;
    names.required = request.on;
    const std::vector<std::string> held_out = held_out_of(request);
    // What the user held out must be there; siblings are ours and may have no place on the object.
    if (request.held_out)
        names.required.insert(names.required.end(), held_out.begin(), held_out.end());
    else
        names.optional = held_out;
    for (const std::string& name : other_loads(names.required))
        names.optional.push_back(name);
    return names;
}

}  // namespace knead::tools
