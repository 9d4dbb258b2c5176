// SPDX-License-Identifier: GPL-3.0-or-later
#include "tune/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace knead::tools {
namespace {

constexpr std::size_t kRowsOfAMesh = 5;

std::vector<std::string> names_of(const TuneResult& result, const std::vector<std::size_t>& loads) {
    std::vector<std::string> names;
    for (const std::size_t load : loads)
        names.push_back(result.loads[load]);
    return names;
}

double budgeted_us(const TuneResult& result, const StepTimes& step) {
    return result.request.budget_is_p50 ? step.p50_us : step.p99_us;
}

std::string percent(double share) {
    return std::isfinite(share) ? fmt::format("{:+.1f} %", 100 * share) : "no rest";
}

std::string level_text(const TuneResult& result, std::size_t candidate) {
    const TuneCandidate& level = result.candidates[candidate];
    return fmt::format("{} on {} tetrahedra", level.recipe.text(), result.meshes[level.mesh].tetrahedra);
}

const TuneMesh* fine_mesh(const TuneResult& result) {
    return result.meshes.back().is_fine ? &result.meshes.back() : nullptr;
}

std::string meshes_text(const TuneResult& result) {
    std::string text = "\n  tetrahedra   p50 us   p99 us  in time  tried  within\n";
    for (std::size_t m = 0; m < result.meshes.size(); ++m) {
        const TuneMesh& mesh = result.meshes[m];
        std::size_t tried = 0, within = 0;
        for (const Trial& trial : result.outcome.trials)
            if (trial.mesh == m) {
                ++tried;
                within += trial.holds ? 1 : 0;
            }
        const bool in_time = budgeted_us(result, mesh.step) <= result.request.budget_us;
        text += fmt::format("  {:>10} {:>8.1f} {:>8.1f}  {:<7}  {:>5}  {:>6}{}\n", mesh.tetrahedra,
                            mesh.step.p50_us, mesh.step.p99_us, in_time ? "yes" : "no", tried, within,
                            mesh.is_fine ? "  (fine: the reference itself)" : "");
    }
    return text;
}

/// Those that got farthest first; equals by the smaller error.
std::vector<Trial> trials_on(const TuneResult& result, std::size_t mesh) {
    std::vector<Trial> trials;
    for (const Trial& trial : result.outcome.trials)
        if (trial.mesh == mesh) trials.push_back(trial);
    std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
        if (a.holds != b.holds) return a.holds;
        if (a.holds) return a.worst.size() < b.worst.size();
        if (a.worst.answers != b.worst.answers) return a.worst.answers > b.worst.answers;
        return a.worst.size() < b.worst.size();
    });
    return trials;
}

std::string candidates_text(const TuneResult& result, bool with_all) {
    std::string text = "\n  candidate                              tetrahedra  looked at  largest error\n";
    for (std::size_t m = 0; m < result.meshes.size(); ++m) {
        const std::vector<Trial> trials = trials_on(result, m);
        std::size_t shown = 0;
        for (const Trial& trial : trials) {
            if (!with_all && shown == kRowsOfAMesh) break;
            text +=
                fmt::format("  {:<38} {:>10} {:>10}  {:>8} ({}, seed {}){}\n",
                            result.candidates[trial.candidate].recipe.text(), result.meshes[m].tetrahedra,
                            trial.worst.answers, percent(trial.worst.error), result.loads[trial.worst.load],
                            trial.worst.seed, trial.holds ? "  within" : "");
            ++shown;
        }
        if (shown < trials.size())
            text += fmt::format("  {:<38} {:>10}\n", fmt::format("... and {} more", trials.size() - shown),
                                result.meshes[m].tetrahedra);
    }
    return text;
}

std::string look_text(const TuneResult& result, const Look& look) {
    const std::string level = level_text(result, look.candidate);
    if (result.candidates[look.candidate].recipe.kind == RecipeKind::fine)
        return fmt::format("{}: {:.1f} us, no error by definition", level, look.step_us);
    if (look.seeds == 0)
        return fmt::format("{}: {:.1f} us when timed itself, over the budget", level, look.step_us);
    return fmt::format("{}: {:.1f} us, seeds {} to {}: {} (largest error {}, {}, seed {})", level,
                       look.step_us, look.first_seed, look.first_seed + look.seeds - 1,
                       look.holds ? "holds" : "fails", percent(look.worst.error),
                       result.loads[look.worst.load], look.worst.seed);
}

std::string looks_text(const TuneResult& result) {
    if (result.outcome.looks.empty()) return {};
    std::string text = "\n  verified, each on seeds of its own:\n";
    for (std::size_t k = 0; k < result.outcome.looks.size(); ++k)
        text += fmt::format("  {}. {}\n", k + 1, look_text(result, result.outcome.looks[k]));
    return text;
}

const char* role_of(const LoadEvidence& load) {
    if (load.was_chosen_on) return "chosen on";
    return load.is_claimed ? "held out" : "not claimed";
}

std::string evidence_text(const TuneResult& result) {
    if (!result.evidence) return {};
    const LevelEvidence& evidence = *result.evidence;
    std::string text = fmt::format(
        "\n  {} on {}:\n  load            role         mean err  largest (seed)   "
        "within  displacement\n",
        level_text(result, evidence.candidate),
        evidence.seeds > 1
            ? fmt::format("seeds {} to {}", evidence.first_seed, evidence.first_seed + evidence.seeds - 1)
            : std::string("the scene's own material (no seed changes it)"));
    for (const LoadEvidence& load : evidence.loads)
        text += fmt::format("  {:<15} {:<11} {:>9}  {:>8} ({:>3})  {:>3}/{:<3}  {:>6.1f} %{}\n", load.load,
                            role_of(load), percent(load.mean), percent(load.worst), load.worst_seed,
                            load.seeds - load.beyond, load.seeds, 100 * load.displacement_error,
                            load.was_fitted ? "  fitted to a load like this" : "");
    return text;
}

std::string papers_text(const TuneResult& result) {
    if (result.papers.empty()) return {};
    std::string text = "\n  the paper's own levels (two bins, dominant) on the claimed loads, same seeds:\n";
    for (const PaperEvidence& paper : result.papers)
        text += fmt::format(
            "  k = {} on {:>5} tetrahedra: misses {:>3} of {:<3}; largest error {} ({}, seed {})\n",
            paper.clusters, result.meshes[paper.mesh].tetrahedra, paper.beyond, paper.answers,
            percent(paper.worst.error), result.loads[paper.worst.load], paper.worst.seed);
    return text;
}

std::string papers_verdict(const TuneResult& result) {
    std::size_t answers = 0, beyond = 0;
    const PaperEvidence* holds = nullptr;
    for (const PaperEvidence& paper : result.papers) {
        answers += paper.answers;
        beyond += paper.beyond;
        if (paper.beyond == 0 && holds == nullptr) holds = &paper;
    }
    if (answers == 0) return {};
    if (holds != nullptr)
        return fmt::format("of the paper's own levels k = {} on {} tetrahedra holds too", holds->clusters,
                           result.meshes[holds->mesh].tetrahedra);
    return fmt::format("the paper's own levels miss in {} of {}, none of them holds", beyond, answers);
}

nlohmann::ordered_json number(double value) {
    if (!std::isfinite(value)) return nullptr;
    return value;
}

nlohmann::ordered_json json_of(const StepTimes& step) {
    return {{"p50", step.p50_us}, {"p99", step.p99_us}, {"p999", step.p999_us}, {"max", step.max_us}};
}

nlohmann::ordered_json json_of(const Worst& worst, const TuneResult& result) {
    return {{"force_error", number(worst.error)},
            {"load", result.loads[worst.load]},
            {"seed", worst.seed},
            {"answers", worst.answers}};
}

nlohmann::ordered_json json_of_candidate(const TuneResult& result, std::size_t candidate) {
    const TuneCandidate& level = result.candidates[candidate];
    const Recipe& recipe = level.recipe;
    nlohmann::ordered_json json{{"text", recipe.text()},
                                {"method", recipe.method_name()},
                                {"tets", result.meshes[level.mesh].tetrahedra}};
    if (recipe.kind == RecipeKind::mix) json["reuss_percent"] = recipe.reuss_percent;
    if (recipe.kind != RecipeKind::method || recipe.method.bins == 0) return json;
    json["bins"] = recipe.method.bins;
    json["clusters"] = recipe.method.clusters;
    json["order"] = recipe.order == BinOrder::stiff_first ? "stiff-first" : "soft-first";
    json["rule"] = recipe.rule == CoarsenRule::dominant ? "dominant" : "volume-average";
    return json;
}

nlohmann::ordered_json json_of(const Trial& trial, const TuneResult& result) {
    nlohmann::ordered_json json = json_of_candidate(result, trial.candidate);
    json["worst"] = json_of(trial.worst, result);
    json["within"] = trial.holds;
    return json;
}

nlohmann::ordered_json json_of(const Look& look, const TuneResult& result) {
    nlohmann::ordered_json json = json_of_candidate(result, look.candidate);
    json["step_us"] = look.step_us;
    json["in_time"] = look.is_in_time;
    json["first_seed"] = look.first_seed;
    json["seeds"] = look.seeds;
    json["worst"] = look.seeds > 0 ? json_of(look.worst, result) : nlohmann::ordered_json(nullptr);
    json["holds"] = look.holds;
    return json;
}

nlohmann::ordered_json evidence_json(const TuneResult& result) {
    if (!result.evidence) return nullptr;
    const LevelEvidence& evidence = *result.evidence;
    nlohmann::ordered_json json = json_of_candidate(result, evidence.candidate);
    json["first_seed"] = evidence.first_seed;
    json["seeds"] = evidence.seeds;
    json["step_us"] = json_of(evidence.step);
    json["runtime_disagreement"] = evidence.runtime_disagreement;
    json["loads"] = nlohmann::ordered_json::array();
    for (const LoadEvidence& load : evidence.loads)
        json["loads"].push_back({{"load", load.load},
                                 {"claimed", load.is_claimed},
                                 {"chosen_on", load.was_chosen_on},
                                 {"fitted", load.was_fitted},
                                 {"seeds", load.seeds},
                                 {"beyond", load.beyond},
                                 {"mean_force_error", load.mean},
                                 {"worst_force_error", number(load.worst)},
                                 {"worst_seed", load.worst_seed},
                                 {"displacement_error", load.displacement_error}});
    return json;
}

nlohmann::ordered_json scene_json(const TuneResult& result) {
    nlohmann::ordered_json json;
    const SearchOutcome& outcome = result.outcome;
    json["name"] = result.name;
    json["reference_tets"] = result.reference_tetrahedra;
    json["within"] = result.request.within;
    json["budget_us"] = result.request.budget_us;
    json["budget_of"] = result.request.budget_is_p50 ? "p50" : "p99";
    json["chosen_on"] = {{"loads", names_of(result, result.chosen_loads)}, {"seeds", result.choosing_seeds}};
    json["claimed"] = {{"loads", names_of(result, result.proven_loads)},
                       {"seeds", result.request.fresh_seeds}};
    json["seeds_draw_material"] = result.seeds_draw_material;
    json["meshes"] = nlohmann::ordered_json::array();
    for (const TuneMesh& mesh : result.meshes)
        json["meshes"].push_back({{"tets", mesh.tetrahedra},
                                  {"fine", mesh.is_fine},
                                  {"of_the_scene", mesh.is_the_scenes},
                                  {"step_us", json_of(mesh.step)},
                                  {"in_time", budgeted_us(result, mesh.step) <= result.request.budget_us}});
    json["candidates"] = nlohmann::ordered_json::array();
    for (const Trial& trial : outcome.trials)
        json["candidates"].push_back(json_of(trial, result));
    json["looks"] = nlohmann::ordered_json::array();
    for (const Look& look : outcome.looks)
        json["looks"].push_back(json_of(look, result));
    json["found"] = outcome.found ? json_of(*outcome.found, result) : nlohmann::ordered_json(nullptr);
    json["nearest_in_time"] =
        outcome.nearest_in_time ? json_of(*outcome.nearest_in_time, result) : nlohmann::ordered_json(nullptr);
    json["nearest_within"] =
        outcome.nearest_within ? json_of(*outcome.nearest_within, result) : nlohmann::ordered_json(nullptr);
    json["evidence"] = evidence_json(result);
    json["papers_own"] = nlohmann::ordered_json::array();
    for (const PaperEvidence& paper : result.papers)
        json["papers_own"].push_back({{"tets", result.meshes[paper.mesh].tetrahedra},
                                      {"clusters", paper.clusters},
                                      {"answers", paper.answers},
                                      {"beyond", paper.beyond},
                                      {"worst", json_of(paper.worst, result)}});
    json["notes"] = result.notes;
    json["seconds"] = result.seconds;
    return json;
}

std::string found_verdict(const TuneResult& result) {
    const Look& found = *result.outcome.found;
    const TuneMesh* const fine = fine_mesh(result);
    if (result.candidates[found.candidate].recipe.kind == RecipeKind::fine)
        return fmt::format("only the raw fine mesh itself ({} tetrahedra, {:.1f} us) is within {:g} %",
                           result.reference_tetrahedra, found.step_us, 100 * result.request.within);
    std::string gain;
    if (fine != nullptr && result.evidence)
        gain = fmt::format(", half of the steps {:.1f} times as fast as the fine mesh's",
                           fine->step.p50_us / result.evidence->step.p50_us);
    return fmt::format("{}: {:.1f} us{}; largest error {} of {} fresh answers",
                       level_text(result, found.candidate), found.step_us, gain, percent(found.worst.error),
                       found.worst.answers);
}

std::string nearest_verdict(const TuneResult& result) {
    std::string text = "no level is within both";
    if (result.outcome.nearest_in_time)
        text += fmt::format("; in time and nearest: {}, largest error {} ({})",
                            level_text(result, result.outcome.nearest_in_time->candidate),
                            percent(result.outcome.nearest_in_time->worst.error),
                            result.loads[result.outcome.nearest_in_time->worst.load]);
    else
        text += "; no mesh is in time";
    if (result.outcome.nearest_within)
        text += fmt::format("; within and fastest: {}, {:.1f} us",
                            level_text(result, result.outcome.nearest_within->candidate),
                            result.outcome.nearest_within->step_us);
    return text;
}

}  // namespace

std::string verdict(const TuneResult& result) {
    std::string text = result.outcome.found ? found_verdict(result) : nearest_verdict(result);
    const std::string papers = papers_verdict(result);
    return result.name + ": " + text + (papers.empty() ? "" : "; " + papers);
}

std::string text_report(const TuneResult& result, bool with_all) {
    const TuneRequest& request = result.request;
    std::string text = fmt::format(
        "{}: errors of forces against {} tetrahedra (fine mesh, raw elasticities)\n"
        "  wanted: at most {:g} % on {}, {} of a step at most {:g} us\n"
        "  chosen on {}, seeds {} to {}; the claim is on these and {}, {} fresh seeds\n",
        result.name, result.reference_tetrahedra, 100 * request.within,
        fmt::join(names_of(result, result.proven_loads), ", "), request.budget_is_p50 ? "p50" : "p99",
        request.budget_us, fmt::join(request.on, ", "), result.choosing_seeds.front(),
        result.choosing_seeds.back(),
        result.proven_loads.size() > result.chosen_loads.size() ? "what is held out" : "nothing held out",
        request.fresh_seeds);
    text += meshes_text(result) + candidates_text(result, with_all) + looks_text(result) +
            evidence_text(result) + papers_text(result);
    for (const std::string& note : result.notes)
        text += "  note: " + note + "\n";
    return text + "\n" + verdict(result) + "\n";
}

nlohmann::ordered_json json_report(const std::vector<TuneResult>& results, const baseline::Machine& machine,
                                   const std::string& command) {
    nlohmann::ordered_json json;
    json["schema"] = "knead-tune/1";
    json["command"] = command;
    json["machine"] = {{"cpu", machine.cpu},
                       {"compiler", machine.compiler},
                       {"os", machine.os},
                       {"load_average", machine.load_average}};
    json["scenes"] = nlohmann::ordered_json::array();
    for (const TuneResult& result : results)
        json["scenes"].push_back(scene_json(result));
    return json;
}

}  // namespace knead::tools
