// SPDX-License-Identifier: Apache-2.0
#include "load/check_numbers.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace knead {
namespace {

/// float32 holds 1e-38 to 3e38; products of a few such numbers and a dt^2 of 1e-7 must stay inside.
constexpr double kSmallest = 1e-30, kLargest = 1e30;
constexpr std::size_t kNamed = 3;

struct Quantity {
    const char* name;
    const char* unit;
    double value;
};

std::array<Quantity, 4> quantities(const Asset& asset, std::size_t t) {
    const Tetrahedron& n = asset.tetrahedra[t];
    const PaletteEntry& material = asset.palette[asset.palette_index[t]];
    const double volume_m3 =
        signed_volume_m3(asset.nodes_m[n[0]], asset.nodes_m[n[1]], asset.nodes_m[n[2]], asset.nodes_m[n[3]]);
    const double e = material.youngs_modulus_pa;
    return {{{"volume", "m^3", volume_m3},
             {"mass", "kg", material.density_kg_per_m3 * volume_m3},
             {"stiffness", "N/m", e * std::cbrt(volume_m3)},
             {"energy", "J", e * volume_m3}}};
}

std::string text(double value) {
    std::array<char, 32> buffer{};
    (void)std::snprintf(buffer.data(), buffer.size(), "%g", value);
    return buffer.data();
}

}  // namespace

Status check_numbers(const Asset& asset) {
    std::size_t count = 0;
    std::string ids, first;
    for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
        for (const Quantity& q : quantities(asset, t)) {
            if (q.value >= kSmallest && q.value <= kLargest) continue;
            if (count == 0) first = std::string(q.name) + " " + text(q.value) + " " + q.unit;
            if (count++ < kNamed) ids += (ids.empty() ? "" : ", ") + std::to_string(t);
            break;
        }
    }
    if (count == 0) return Unit{};
    return Error{ErrorCode::invalid_data,
                 std::to_string(count) + " of " + std::to_string(asset.tetrahedra.size()) + " tetrahedra (" +
                     ids + ") are beyond what a step can compute with, 1e-30 to 1e30: " + first +
                     "; are lengths in metres, elasticities in pascals and densities in kg/m^3?",
                 asset.name};
}

}  // namespace knead
