// SPDX-License-Identifier: GPL-3.0-or-later
#include "tune/recipe.h"

#include <fmt/format.h>

#include <algorithm>

namespace knead::tools {
namespace {

constexpr const char* kMix = "mix";
constexpr const char* kFine = "fine";
/// Shares of Reuss that are tried; half is Hill.
constexpr std::uint32_t kMixPercents[] = {5, 10, 15, 20, 25, 30, 40};

void add_papers(const RecipeChoice& choice, std::vector<Recipe>& recipes) {
    for (const std::uint32_t bins : choice.bins)
        for (const std::uint32_t clusters : choice.clusters)
            for (const CoarsenRule rule : {CoarsenRule::dominant, CoarsenRule::volume_average})
                for (const BinOrder order : {BinOrder::stiff_first, BinOrder::soft_first})
                    recipes.push_back(
                        {RecipeKind::method, {MethodKind::paper, bins, clusters}, order, rule, 0});
}

Recipe simple(MethodKind kind) {
    Recipe recipe;
    recipe.method = {kind, 0, 0};
    if (kind == MethodKind::homogenised) recipe.method = {kind, 1, 1};
    return recipe;
}

}  // namespace

std::string Recipe::text() const {
    if (kind == RecipeKind::fine) return kFine;
    if (kind == RecipeKind::mix) return fmt::format("mix {} %", reuss_percent);
    std::string text = method.text();
    if (method.kind != MethodKind::paper) return text;
    if (order == BinOrder::soft_first) text += " soft-first";
    if (rule == CoarsenRule::volume_average) text += " volume-average";
    return text;
}

std::string Recipe::method_name() const {
    if (kind == RecipeKind::fine) return kFine;
    if (kind == RecipeKind::mix) return kMix;
    return name_of(method.kind);
}

bool Recipe::is_the_papers() const {
    return *this == papers_recipe(method.clusters);
}

const std::vector<std::string>& tunable_methods() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const std::string& name : method_names())
            if (name != name_of(MethodKind::kmod09)) all.push_back(name);
        all.insert(all.end(), {kMix, kFine});
        return all;
    }();
    return names;
}

std::vector<Recipe> recipes_of(const RecipeChoice& choice) {
    const auto wanted = [&](const std::string& name) {
        return std::find(choice.methods.begin(), choice.methods.end(), name) != choice.methods.end();
    };
    std::vector<Recipe> recipes;
    for (const MethodKind kind :
         {MethodKind::homogenised, MethodKind::voigt, MethodKind::raw_dominant, MethodKind::hill,
          MethodKind::geometric, MethodKind::reuss, MethodKind::iycn13, MethodKind::calibrated})
        if (wanted(name_of(kind))) recipes.push_back(simple(kind));
    if (wanted(kMix))
        for (const std::uint32_t percent : kMixPercents)
            recipes.push_back({RecipeKind::mix, {}, BinOrder::stiff_first, CoarsenRule::dominant, percent});
    if (wanted(name_of(MethodKind::paper))) add_papers(choice, recipes);
    return recipes;
}

Recipe papers_recipe(std::uint32_t clusters) {
    Recipe recipe;
    recipe.method = {MethodKind::paper, 2, clusters};
    return recipe;
}

}  // namespace knead::tools
