// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "aggregate/aggregate.h"
#include "coarsen/coarsen.h"
#include "evaluate/methods.h"

namespace knead::tools {

/// What makes the elasticities of a level: the methods of knead-evaluate, and what only a search needs.
enum class RecipeKind : std::uint8_t {
    method,  ///< one of knead-evaluate's; the paper's with any order and rule
    mix,     ///< between the bounds: share * Reuss + (1 - share) * Voigt
    fine     ///< the raw elasticities on the fine mesh: the reference itself
};

struct Recipe {
    RecipeKind kind = RecipeKind::method;
    Method method;                             ///< kind method
    BinOrder order = BinOrder::stiff_first;    ///< method paper
    CoarsenRule rule = CoarsenRule::dominant;  ///< method paper
    std::uint32_t reuss_percent = 0;           ///< kind mix

    /// "paper 2x3", "paper 2x3 soft-first volume-average", "mix 20 %", "fine"
    [[nodiscard]] std::string text() const;
    /// The name that --methods knows it by.
    [[nodiscard]] std::string method_name() const;
    /// Whether the seed of k-means changes it.
    [[nodiscard]] bool uses_seed() const { return kind == RecipeKind::method && method.uses_seed(); }
    /// Whether it is one of the paper's own levels: two bins, dominant rule, stiff first.
    [[nodiscard]] bool is_the_papers() const;
    bool operator==(const Recipe&) const = default;
};

/// What a search may choose from.
struct RecipeChoice {
    std::vector<std::string> methods;  ///< of tunable_methods()
    std::vector<std::uint32_t> bins;
    std::vector<std::uint32_t> clusters;
};

/// Names of --methods: those of knead-evaluate that the runtime can run, mix and fine.
[[nodiscard]] const std::vector<std::string>& tunable_methods();

/// Every recipe for a coarse mesh that the choice allows, simple ones first; `fine` is not among them.
[[nodiscard]] std::vector<Recipe> recipes_of(const RecipeChoice& choice);

/// The paper's own: two bins, `clusters` in each.
[[nodiscard]] Recipe papers_recipe(std::uint32_t clusters);

}  // namespace knead::tools
