// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluate/evaluation.h"
#include "evaluate/runtime_side.h"
#include "evaluate/speed.h"
#include "tune/recipe.h"
#include "tune/search.h"
#include "tune/tuned_scene.h"

namespace knead::tools {

/// What is asked of the fastest level. Names are valid (options.h checks them).
struct TuneRequest {
    double within = 0.1;          ///< largest |force error|
    double budget_us = 0;         ///< of one step
    bool budget_is_p50 = false;   ///< else the 99th percentile
    std::vector<std::string> on;  ///< loads to choose on
    /// Loads that belong to the claim and are not chosen on; nothing: the siblings of `on`.
    std::optional<std::vector<std::string>> held_out;
    RecipeChoice choice;
    std::vector<std::string> levels;  ///< empty: the scene's meshes and generated ones
    std::uint32_t choosing_seeds = 3;
    std::uint32_t fresh_seeds = 10;
    int steps = 250;   ///< timed at a time: one press
    int repeats = 40;  ///< of the timing; the lowest counts
};

/// One recipe on one mesh; the position in TuneResult::candidates is its number in the search.
struct TuneCandidate {
    std::size_t mesh = 0;
    Recipe recipe;
};

struct TuneMesh {
    std::size_t tetrahedra = 0;
    bool is_fine = false;
    bool is_the_scenes = false;
    StepTimes step;    ///< of a level of this mesh
    std::string text;  ///< "of 7 x 7 x 7 cubes"
};

/// Errors under one load over some seeds.
struct LoadEvidence {
    std::string load;
    bool is_claimed = false;  ///< else only shown
    bool was_chosen_on = false;
    bool was_fitted = false;  ///< the method saw this load when it was made (calibrated)
    std::size_t seeds = 0;
    std::size_t beyond = 0;  ///< seeds on which it is not within, or did not converge
    double mean = 0;         ///< signed, over what converged
    double worst = 0;        ///< signed; infinite when one did not converge
    std::uint64_t worst_seed = 0;
    double displacement_error = 0;  ///< mean
};

/// A level on fresh seeds.
struct LevelEvidence {
    std::size_t candidate = 0;
    std::uint64_t first_seed = 0;
    std::uint32_t seeds = 0;
    StepTimes step;  ///< timed itself
    std::vector<LoadEvidence> loads;
    double runtime_disagreement = 0;  ///< of the runtime from the reference solver, the scene's tool pressed
};

/// One of the paper's own levels on the same loads and seeds.
struct PaperEvidence {
    std::size_t mesh = 0;
    std::uint32_t clusters = 0;
    std::size_t answers = 0;
    std::size_t beyond = 0;
    Worst worst;  ///< load: number in TuneResult::loads
};

struct TuneResult {
    std::string name;
    std::size_t reference_tetrahedra = 0;
    TuneRequest request;
    std::vector<std::string> loads;         ///< all that were asked for
    std::vector<std::size_t> chosen_loads;  ///< numbers in `loads`
    std::vector<std::size_t> proven_loads;  ///< numbers in `loads`: the claim
    std::vector<std::uint64_t> choosing_seeds;
    bool seeds_draw_material = false;
    std::vector<TuneMesh> meshes;  ///< the fine one last
    std::vector<TuneCandidate> candidates;
    SearchOutcome outcome;
    std::optional<LevelEvidence> evidence;  ///< of what was found, or of what comes nearest in time
    std::vector<PaperEvidence> papers;
    std::vector<std::string> notes;
    double seconds = 0;
};

/// Tunes one scene. @throws ToolError for a scene or a load that makes no sense, or when runtime and
/// reference solver disagree on what was found
[[nodiscard]] TuneResult tune(const TunedScene& scene, const TuneRequest& request,
                              const std::function<void(std::string_view)>& tell);

/// The loads that a request needs.
[[nodiscard]] LoadNames load_names(const TuneRequest& request);

}  // namespace knead::tools
