// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/region_adapted.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/geometry.h"

namespace knead::tools {
namespace {

constexpr std::uint32_t kSteps = 120;
constexpr double kNarrowest = 0.5;  ///< of an equal share
/// Of the profile's variance, for an interval twice as wide as its share: noise of drawn elasticities is
/// below.
constexpr double kUnequalPenalty = 0.02;
constexpr double kFlat = 1e-9;  ///< of the mean square

/// Sums over the first steps, so that the variance of any run of them is a difference.
struct RunningSums {
    std::vector<double> value{0}, square{0};
    explicit RunningSums(const std::vector<double>& profile) {
        for (std::uint32_t step = 0; step < kSteps; ++step) {
            const auto at =
                static_cast<std::size_t>((step + 0.5) / kSteps * static_cast<double>(profile.size()));
            value.push_back(value.back() + profile[at] / kSteps);
            square.push_back(square.back() + profile[at] * profile[at] / kSteps);
        }
    }
    /// Integral of the squared distance to the mean.
    [[nodiscard]] double variance(std::uint32_t from, std::uint32_t to) const {
        const double width = static_cast<double>(to - from) / kSteps;
        const double sum = value[to] - value[from];
        return std::max(0.0, square[to] - square[from] - sum * sum / width);
    }
};

std::array<std::uint32_t, 3> divisions_of(const MeshSource& source) {
    const auto& d = source.divisions;
    if (d.size() == 1) return {d[0], d[0], d[0]};
    return {d.at(0), d.at(1), d.at(2)};
}

std::array<double, 3> size_of(const MeshSource& source) {
    const auto& s = source.size_m;
    if (s.size() == 1) return {s[0], s[0], s[0]};
    return {s.at(0), s.at(1), s.at(2)};
}

std::vector<double> profile_along(const MaterialObject& fine, std::size_t axis, std::uint32_t layers,
                                  double size_m) {
    std::vector<double> sum(layers, 0);
    std::vector<double> volume(layers, 0);
    for (std::size_t t = 0; t < fine.mesh.tetrahedra.size(); ++t) {
        const double share = barycentre_m(fine.mesh, t)[axis] / size_m;
        const auto layer = std::min(layers - 1, static_cast<std::uint32_t>(share * layers));
        const double v = signed_volume_m3(fine.mesh, t);
        sum[layer] += v * std::log(fine.material.youngs_modulus_pa[t]);
        volume[layer] += v;
    }
    for (std::uint32_t layer = 0; layer < layers; ++layer)
        sum[layer] /= volume[layer];
    return sum;
}

}  // namespace

std::vector<double> cut_profile(const std::vector<double>& profile, std::uint32_t parts) {
    if (parts >= kSteps) {  // finer than what is searched
        std::vector<double> equal;
        for (std::uint32_t k = 0; k <= parts; ++k)
            equal.push_back(static_cast<double>(k) / parts);
        return equal;
    }
    const RunningSums sums(profile);
    // What varies less than this is rounding.
    const double flat = kFlat * std::max(sums.square.back(), std::numeric_limits<double>::min());
    const double scale = std::max(sums.variance(0, kSteps), flat);
    const auto narrowest =
        std::max(1U, static_cast<std::uint32_t>(std::ceil(kNarrowest * kSteps / static_cast<double>(parts))));
    const auto cost = [&](std::uint32_t from, std::uint32_t to) {
        const double excess = static_cast<double>(parts) * (to - from) / kSteps - 1;
        return sums.variance(from, to) / scale + kUnequalPenalty * excess * excess;
    };
    constexpr double kNever = std::numeric_limits<double>::infinity();
    std::vector<std::vector<double>> best(parts + 1, std::vector<double>(kSteps + 1, kNever));
    std::vector<std::vector<std::uint32_t>> before(parts + 1, std::vector<std::uint32_t>(kSteps + 1, 0));
    best[0][0] = 0;
    for (std::uint32_t part = 1; part <= parts; ++part)
        for (std::uint32_t to = part * narrowest; to <= kSteps; ++to)
            for (std::uint32_t from = 0; from + narrowest <= to; ++from) {
                if (best[part - 1][from] == kNever) continue;
                const double value = best[part - 1][from] + cost(from, to);
                if (value >= best[part][to]) continue;
                best[part][to] = value;
                before[part][to] = from;
            }
    std::vector<double> borders(parts + 1, 1.0);
    std::uint32_t at = kSteps;
    for (std::uint32_t part = parts; part > 0; --part) {
        borders[part] = static_cast<double>(at) / kSteps;
        at = before[part][at];
    }
    borders[0] = 0;
    return borders;
}

TetMesh region_adapted_mesh(const MaterialObject& fine, const MeshSource& fine_source,
                            const MeshSource& level_source) {
    const auto divisions = divisions_of(level_source);
    const auto size_m = size_of(level_source);
    TetMesh mesh = make_cubes(divisions, size_m);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::vector<double> borders = cut_profile(
            profile_along(fine, axis, divisions_of(fine_source)[axis], size_m[axis]), divisions[axis]);
        for (Point& node : mesh.nodes_m) {
            const auto plane =
                static_cast<std::size_t>(std::lround(node[axis] / size_m[axis] * divisions[axis]));
            node[axis] = borders[plane] * size_m[axis];
        }
    }
    return mesh;
}

}  // namespace knead::tools
