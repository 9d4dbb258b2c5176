// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

namespace knead::tools {

/// The search for the fastest level that holds: what to try in which order, when to give a candidate up, and
/// what counts as proof. Knows nothing of objects; errors and times come from callbacks.
///
/// Index meanings: a candidate is a position in `SearchSpace::meshes[...].candidates`' numbers, a load a
/// number below the callbacks' own count. Errors are signed shares of a force.
struct SearchMesh {
    double step_us = 0;                   ///< of any asset of this mesh
    std::vector<std::size_t> candidates;  ///< in the order of preference between equals
    bool is_exact = false;                ///< its candidates are the reference itself: error 0, not verified
};

/// The error of one candidate under one load for one seed; infinite when there is no answer.
using ErrorOf = std::function<double(std::size_t candidate, std::uint64_t seed, std::size_t load)>;

struct SearchSpace {
    std::vector<SearchMesh> meshes;
    double within = 0;     ///< largest |error|
    double budget_us = 0;  ///< largest step time
    std::vector<std::uint64_t> choosing_seeds;
    std::uint32_t fresh_seeds = 10;         ///< of each look
    std::uint32_t looks_on_a_mesh = 3;      ///< candidates of one mesh that are verified at most
    std::vector<std::size_t> chosen_loads;  ///< those to choose on, the hardest first
    std::vector<std::size_t> proven_loads;  ///< those to verify on: the chosen ones and the held out

    ErrorOf error;                                               ///< called from several threads at once
    std::function<double(std::size_t candidate)> step_us;        ///< timed itself; nothing else runs then
    std::function<bool(std::size_t candidate)> depends_on_seed;  ///< false: one seed says it all
    std::function<void(std::string_view)> tell;                  ///< progress; may be empty
};

/// The largest |error| of a set of loads and seeds.
struct Worst {
    double error = 0;  ///< signed
    std::size_t load = 0;
    std::uint64_t seed = 0;
    std::size_t answers = 0;  ///< how many were looked at
    void add(double next, std::size_t of_load, std::uint64_t of_seed);
    [[nodiscard]] double size() const { return error < 0 ? -error : error; }
};

/// A candidate on the choosing seeds. Given up at the first error that is too large.
struct Trial {
    std::size_t candidate = 0;
    std::size_t mesh = 0;
    Worst worst;
    bool holds = false;  ///< everything was looked at and is within
};

/// A candidate on seeds that nothing was chosen on. Each look is a choice again, and so has seeds of its own.
struct Look {
    std::size_t candidate = 0;
    std::size_t mesh = 0;
    std::uint64_t first_seed = 0;
    std::uint32_t seeds = 0;  ///< that were looked at; fewer than asked for when one failed
    double step_us = 0;       ///< timed itself
    Worst worst;
    bool holds = false;      ///< on all proven loads and all fresh seeds
    bool is_in_time = true;  ///< of the budget; false: not verified
};

struct SearchOutcome {
    std::vector<Trial> trials;  ///< in the order tried
    std::vector<Look> looks;    ///< in the order of the seeds
    std::optional<Look> found;  ///< holds, in time: the answer
    /// Nothing was found: in time, and with the least error on all that was looked at.
    std::optional<Trial> nearest_in_time;
    std::optional<Look> nearest_within;  ///< nothing was found: holds, and is the fastest that does
};

/// Meshes from the fastest to the slowest. On each, every candidate is tried on the choosing seeds and given
/// up at its first error beyond `within`; those that hold are timed and verified, the smallest worst error
/// first (they are equally fast), each on fresh seeds. The first that holds is the answer.
///
/// Without an answer: the search goes on beyond the budget for the fastest that holds, and among the
/// candidates in time the one with the least worst error is found, looking at no more than is needed to know.
/// The outcome does not depend on the number of threads.
[[nodiscard]] SearchOutcome search(const SearchSpace& space);

}  // namespace knead::tools
