// SPDX-License-Identifier: GPL-3.0-or-later
#include "tune/search.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knead::tools {
namespace {

template <class Call>
void in_parallel(std::size_t count, const Call& call) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t k = range.begin(); k < range.end(); ++k)
                call(k);
        },
        tbb::simple_partitioner());
}

class Search {
  public:
    explicit Search(const SearchSpace& space) : space_(space), order_(space.meshes.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
            return space.meshes[a].step_us < space.meshes[b].step_us;
        });
        next_fresh_ = 1 + *std::max_element(space.choosing_seeds.begin(), space.choosing_seeds.end());
    }

    SearchOutcome run() {
        for (const std::size_t mesh : order_)
            if (space_.meshes[mesh].step_us <= space_.budget_us && search_mesh(mesh, space_.budget_us)) break;
        if (!outcome_.found) {
            find_nearest_in_time();
            find_nearest_within();
        }
        return std::move(outcome_);
    }

  private:
    /// What a candidate is chosen on, in the order of looking: [seeds][loads].
    [[nodiscard]] std::size_t choosing_seed_count(std::size_t candidate) const {
        return space_.depends_on_seed(candidate) ? space_.choosing_seeds.size() : 1;
    }

    /// Looks at one more answer. @return false when there is none left
    bool look_on(Trial& trial) const {
        const std::size_t at = trial.worst.answers;
        const std::size_t loads = space_.chosen_loads.size();
        if (at >= choosing_seed_count(trial.candidate) * loads) return false;
        const std::uint64_t seed = space_.choosing_seeds[at / loads];
        const std::size_t load = space_.chosen_loads[at % loads];
        trial.worst.add(space_.error(trial.candidate, seed, load), load, seed);
        return true;
    }

    [[nodiscard]] std::vector<Trial> try_all(std::size_t mesh) const {
        const std::vector<std::size_t>& candidates = space_.meshes[mesh].candidates;
        std::vector<Trial> trials(candidates.size());
        in_parallel(candidates.size(), [&](std::size_t k) {
            Trial& trial = trials[k];
            trial.candidate = candidates[k];
            trial.mesh = mesh;
            bool more = true;
            while (more && trial.worst.size() <= space_.within)
                more = look_on(trial);
            trial.holds = trial.worst.size() <= space_.within;
        });
        return trials;
    }

    /// Whether it holds on fresh seeds; stops at the first seed on which it does not.
    void verify(Look& look) {
        const bool seeds_matter = space_.depends_on_seed(look.candidate);
        look.first_seed = seeds_matter ? next_fresh_ : space_.choosing_seeds.front();
        const std::uint32_t seeds = seeds_matter ? space_.fresh_seeds : 1;
        if (seeds_matter) next_fresh_ += space_.fresh_seeds;
        std::vector<double> errors(space_.proven_loads.size());
        for (look.holds = true; look.seeds < seeds && look.holds; ++look.seeds) {
            const std::uint64_t seed = look.first_seed + look.seeds;
            in_parallel(errors.size(), [&](std::size_t k) {
                errors[k] = space_.error(look.candidate, seed, space_.proven_loads[k]);
            });
            for (std::size_t k = 0; k < errors.size(); ++k)
                look.worst.add(errors[k], space_.proven_loads[k], seed);
            look.holds = look.worst.size() <= space_.within;
        }
    }

    /// Times and verifies one that held on the choosing seeds.
    Look prove(std::size_t candidate, std::size_t mesh, double budget_us) {
        Look look;
        look.candidate = candidate;
        look.mesh = mesh;
        look.step_us = space_.step_us(candidate);
        look.is_in_time = look.step_us <= budget_us;
        if (space_.meshes[mesh].is_exact)
            look.holds = true;
        else if (look.is_in_time)
            verify(look);
        return look;
    }

    [[nodiscard]] static std::vector<Trial> by_margin(const std::vector<Trial>& trials) {
        std::vector<Trial> holding;
        for (const Trial& trial : trials)
            if (trial.holds) holding.push_back(trial);
        std::stable_sort(holding.begin(), holding.end(),
                         [](const Trial& a, const Trial& b) { return a.worst.size() < b.worst.size(); });
        return holding;
    }

    bool search_mesh(std::size_t mesh, double budget_us) {
        std::vector<Trial> holding;
        if (space_.meshes[mesh].is_exact) {
            for (const std::size_t candidate : space_.meshes[mesh].candidates)
                holding.push_back({candidate, mesh, {}, true});
        } else {
            const std::vector<Trial> trials = try_all(mesh);
            outcome_.trials.insert(outcome_.trials.end(), trials.begin(), trials.end());
            holding = by_margin(trials);
        }
        tell(fmt::format("{} candidates at {:.0f} us: {} within on the choosing seeds",
                         space_.meshes[mesh].candidates.size(), space_.meshes[mesh].step_us, holding.size()));
        for (std::size_t k = 0; k < holding.size() && k < space_.looks_on_a_mesh; ++k) {
            const Look look = prove(holding[k].candidate, mesh, budget_us);
            outcome_.looks.push_back(look);
            if (!look.holds || !look.is_in_time) continue;
            (std::isfinite(budget_us) ? outcome_.found : outcome_.nearest_within) = look;
            return true;
        }
        return false;
    }

    /// Best first: of all candidates in time, the one whose largest error so far is least is looked at on,
    /// until one has nothing left to be looked at. What failed on fresh seeds carries that along.
    void find_nearest_in_time() {
        std::vector<Trial> open;
        for (const Trial& trial : outcome_.trials)
            if (space_.meshes[trial.mesh].step_us <= space_.budget_us) open.push_back(trial);
        const auto bound = [&](const Trial& trial) {
            double size = trial.worst.size();
            for (const Look& look : outcome_.looks)
                if (look.candidate == trial.candidate) size = std::max(size, look.worst.size());
            return size;
        };
        while (!open.empty()) {
            const auto best = std::min_element(open.begin(), open.end(), [&](const Trial& a, const Trial& b) {
                return bound(a) < bound(b);
            });
            if (!std::isfinite(bound(*best))) return;
            if (look_on(*best)) continue;
            outcome_.nearest_in_time = *best;
            for (const Look& look : outcome_.looks)
                if (look.candidate == best->candidate && look.worst.size() > best->worst.size())
                    outcome_.nearest_in_time->worst = look.worst;
            return;
        }
    }

    /// What held but was too slow when timed itself counts; else on with the meshes beyond the budget.
    void find_nearest_within() {
        const std::vector<Look> before = outcome_.looks;
        for (Look look : before) {
            if (look.is_in_time) continue;
            if (!look.holds) {
                verify(look);
                outcome_.looks.push_back(look);
            }
            if (!look.holds) continue;
            outcome_.nearest_within = look;
            return;
        }
        for (const std::size_t mesh : order_)
            if (space_.meshes[mesh].step_us > space_.budget_us &&
                search_mesh(mesh, std::numeric_limits<double>::infinity()))
                return;
    }

    void tell(const std::string& text) const {
        if (space_.tell) space_.tell(text);
    }

    const SearchSpace& space_;
    std::vector<std::size_t> order_;  // meshes, fastest first
    std::uint64_t next_fresh_ = 0;
    SearchOutcome outcome_;
};

}  // namespace

void Worst::add(double next, std::size_t of_load, std::uint64_t of_seed) {
    if (answers == 0 || std::abs(next) > size()) {
        error = next;
        load = of_load;
        seed = of_seed;
    }
    ++answers;
}

SearchOutcome search(const SearchSpace& space) {
    return Search(space).run();
}

}  // namespace knead::tools
