// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/checks.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "common/error.h"

namespace knead::tools {
namespace {

constexpr std::size_t kIdsShown = 5;

/// Refuses the values that share the first fault found, naming the first of them.
template <class WhyNot>
void refuse_if_any(const std::vector<double>& values, WhyNot why_not, const std::string& quantity) {
    std::string reason;
    std::size_t count = 0;
    std::vector<std::size_t> ids;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto fault = why_not(values[i]);
        if (!fault || (count > 0 && *fault != reason)) continue;
        reason = *fault;
        if (++count <= kIdsShown) ids.push_back(i);
    }
    if (count > 0)
        fail_input(fmt::format("{} of {} values of {} are {} (tetrahedra counted from 0: {}{})", count,
                               values.size(), quantity, reason, fmt::join(ids, ", "),
                               count > kIdsShown ? ", ..." : ""));
}

}  // namespace

std::optional<std::string> why_not_positive(double value) {
    if (std::isfinite(value) && value > 0) return std::nullopt;
    return "not positive and finite";
}

std::optional<std::string> why_not_poissons_ratio(double value) {
    if (value > -1 && value < 0.5) return std::nullopt;
    if (std::isfinite(value) && value >= 0.5)
        return "0.5 or more: the solid would be incompressible, and linear tetrahedra lock; use 0.49 or less";
    return "not between -1 and 0.5: no elastic solid is like that";
}

void require_physical(const Material& material) {
    refuse_if_any(material.youngs_modulus_pa, why_not_positive, "Young's modulus");
    refuse_if_any(material.poissons_ratio, why_not_poissons_ratio, "Poisson's ratio");
    refuse_if_any(material.density_kg_per_m3, why_not_positive, "density");
}

}  // namespace knead::tools
