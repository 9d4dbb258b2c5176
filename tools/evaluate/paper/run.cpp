// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/paper/run.h"

#include <array>
#include <iterator>

#include "common/error.h"
#include "scene/scene.h"

namespace knead::tools {
namespace {

constexpr const char* kSteak = "steak";
constexpr std::uint32_t kBins = 2;

EvaluationRequest with_methods(EvaluationRequest request, const std::array<std::uint32_t, 3>& clusters) {
    request.methods = {{MethodKind::homogenised, 1, 1}};
    for (const std::uint32_t k : clusters)
        request.methods.push_back({MethodKind::paper, kBins, k});
    request.reference = ReferenceKind::fine;
    request.with_curves = request.with_states = request.with_baseline = true;
    return request;
}

EvaluationRequest cubes_request(const EvaluationRequest& asked) {
    EvaluationRequest request = with_methods(asked, {1, 3, 6});
    request.levels = {"fine", "3072", "1296"};
    request.loads = {"press10"};
    return request;
}

EvaluationRequest steak_request(const EvaluationRequest& asked) {
    EvaluationRequest request = with_methods(asked, {1, 3, 10});
    request.levels = {};
    request.loads = {"scene"};
    return request;
}

}  // namespace

bool is_scenario(const std::string& scene) {
    const std::string stem = "scenario";
    return scene.size() == stem.size() + 1 && scene.compare(0, stem.size(), stem) == 0 &&
           scene.back() >= '1' && scene.back() <= '9';
}

std::vector<SceneResult> evaluate_paper(const EvaluationRequest& request, const ResultCache& cache,
                                        const FileReader& read, const EvaluationListener& listener) {
    EvaluationRequest cubes = cubes_request(request), steak = steak_request(request);
    cubes.scenes.clear();
    steak.scenes.clear();
    for (const auto& file : request.scenes) {
        const std::string name = read_scene(file).name;
        if (!is_scenario(name) && name != kSteak)
            fail_usage(file.string() + ": the paper has no scene \"" + name +
                       "\" (it has scenario1 to scenario9 and steak)");
        (is_scenario(name) ? cubes : steak).scenes.push_back(file);
    }
    std::vector<SceneResult> results = evaluate(cubes, cache, read, listener);
    std::vector<SceneResult> of_steak = evaluate(steak, cache, read, listener);
    std::move(of_steak.begin(), of_steak.end(), std::back_inserter(results));
    return results;
}

}  // namespace knead::tools
