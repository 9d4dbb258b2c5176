// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/conditioning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace knead::tools {
namespace {

/// 3 V over the height on each node, squared: area^2, from which the gradients of the shape functions follow.
std::array<double, 4> squared_areas_m4(const Asset& asset, const Tetrahedron& t) {
    std::array<double, 4> result{};
    for (std::size_t k = 0; k < 4; ++k) {
        const Point& a = asset.nodes_m[t[(k + 1) % 4]];
        const Point& b = asset.nodes_m[t[(k + 2) % 4]];
        const Point& c = asset.nodes_m[t[(k + 3) % 4]];
        const Point u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        const Point v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
        const Point n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        result[k] = 0.25 * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    return result;
}

/// lambda + 2 mu, the modulus of a pressure wave.
double wave_modulus_pa(const PaletteEntry& entry) {
    const double nu = entry.poissons_ratio;
    return entry.youngs_modulus_pa * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
}

/// Nodes that are neither held nor bonded to the first tool, the one that is simulated unless the application
/// asks for more.
std::vector<bool> moves_by_itself(const Asset& asset) {
    std::vector<bool> moves(asset.nodes_m.size(), false);
    std::fill_n(moves.begin(), asset.free_node_count, true);
    if (!asset.tools.empty() && asset.tools[0].contact == ToolContact::bonded)
        for (const std::uint32_t node : asset.tools[0].nodes)
            moves[node] = false;
    return moves;
}

}  // namespace

bool Conditioning::mass_rules(double dt_s) const {
    return dt_s * dt_s * stiffness_over_mass_per_s2 <= kSparseInverseMaxStiffness;
}

Preconditioner Conditioning::preconditioner_at(double dt_s) const {
    return mass_rules(dt_s) ? Preconditioner::sparse_inverse : numerics.preconditioner;
}

Conditioning condition_of(const Asset& asset) {
    Conditioning result;
    result.numerics = choose_numerics(asset);
    const std::vector<bool> moves = moves_by_itself(asset);
    std::vector<double> stiffness(asset.nodes_m.size(), 0);
    double mass_kg = 0;
    result.fastest_crossing_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < asset.tetrahedra.size(); ++i) {
        const Tetrahedron& t = asset.tetrahedra[i];
        const PaletteEntry& entry = asset.palette[asset.palette_index[i]];
        const double volume_m3 = signed_volume_m3(asset.nodes_m[t[0]], asset.nodes_m[t[1]],
                                                  asset.nodes_m[t[2]], asset.nodes_m[t[3]]);
        const double modulus_pa = wave_modulus_pa(entry);
        const std::array<double, 4> areas = squared_areas_m4(asset, t);
        for (std::size_t k = 0; k < 4; ++k) {
            if (!moves[t[k]]) continue;
            stiffness[t[k]] += modulus_pa * areas[k] / (9 * volume_m3);
            mass_kg += 0.25 * entry.density_kg_per_m3 * volume_m3;
        }
        const double height_m = 3 * volume_m3 / std::sqrt(*std::max_element(areas.begin(), areas.end()));
        result.fastest_crossing_s =
            std::min(result.fastest_crossing_s, height_m * std::sqrt(entry.density_kg_per_m3 / modulus_pa));
    }
    double sum = 0, softest = std::numeric_limits<double>::infinity(), stiffest = 0;
    for (std::size_t n = 0; n < stiffness.size(); ++n) {
        if (!moves[n]) continue;
        sum += stiffness[n];
        softest = std::min(softest, stiffness[n]);
        stiffest = std::max(stiffest, stiffness[n]);
    }
    if (sum > 0) {
        result.node_stiffness_spread = stiffest / softest;
        result.stiffness_over_mass_per_s2 = sum / mass_kg;
    }
    return result;
}

}  // namespace knead::tools
