// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "knead/runtime/simulation.h"
#include "stability/script.h"
#include "stability/specimen.h"

namespace knead::tools::stability {

/// The force of one tool in one step, and what the reference says.
struct ForceSample {
    double difference_n = 0;
    double reference_n = 0;  ///< its size
    bool told = false;       ///< the step said that it is not sure
};

/// What happened in a run; nothing is judged here.
struct Record {
    std::uint64_t steps = 0;
    /// Steps that told it.
    std::uint64_t not_converged = 0, contact_cap = 0, not_finite = 0, bad_input = 0, inside_out = 0;
    bool finite = true;    ///< every force, position and velocity that came out
    bool complete = true;  ///< false: cut at criteria::kMostSteps
    double mean_iterations = 0;
    std::uint32_t most_iterations = 0;
    double largest_force_n = 0;
    double force_away_n = 0;  ///< largest after the tool has left

    std::vector<ForceSample> against_linearised, against_converged;
    std::optional<ForceSample> at_rest;  ///< at the end of the hold
    std::size_t reference_refused = 0;   ///< solves in which the reference found no answer
    std::string reference_words;         ///< of the first of them
    std::size_t not_compared = 0;        ///< samples left out: the touched set changed in that step

    double positive_work_j = 0;       ///< of the hand
    double energy_over_work = 0;      ///< largest (energy - slack) / positive work so far
    double energy_over_net_work = 0;  ///< largest (energy - net work - slack) / positive work so far
    double growth_while_still = 0;    ///< largest (energy - least before - slack) / positive work

    double off_rest = 0;          ///< root mean square, over the size, at the end
    double strongest_pull_n = 0;  ///< of unilateral tools, along the mean normal
    double cone_excess_n = 0;     ///< plates only: |tangential| - mu normal
    double deepest_m = 0;         ///< penetration of touchable nodes
    std::uint64_t touching_steps = 0;
    bool touches_at_end = false;  ///< a unilateral tool, though it has left

    double first_tenth_force_n = 0, last_tenth_force_n = 0;  ///< largest, of a soak
    double first_tenth_energy_j = 0, last_tenth_energy_j = 0;
};

struct RunOptions {
    SimulationConfig config = {};
    std::size_t compared_steps = 0;  ///< with the reference; 0: none
    bool compare_converged = true;   ///< also with the converged nonlinear step
    bool force_at_rest = true;
    std::uint64_t most_steps = 0;  ///< 0: criteria::kMostSteps
    /// Seam for the tests of the matrix: falsifies what the runtime answered before it is looked at.
    std::function<void(std::uint64_t step, ToolResult& tool, std::uint32_t& status)> tamper = {};
};

/// @throws ToolError when the runtime refuses the asset or the configuration
[[nodiscard]] Record run(const Specimen& specimen, const Script& script, const RunOptions& options);

/// @throws ToolError(no_valid_result) with the library's words
[[nodiscard]] Simulation simulation_of(const Specimen& specimen, const SimulationConfig& config);
/// All tools of the asset, expecting that dt.
[[nodiscard]] SimulationConfig config_for(const Specimen& specimen, double dt_s);

}  // namespace knead::tools::stability
