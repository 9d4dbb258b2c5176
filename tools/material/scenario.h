// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "knead/formats/material.h"

namespace knead::tools {

inline constexpr int kFirstScenario = 1;
inline constexpr int kLastScenario = 9;

/// A zone of a scenario: a connected part of the bounding box in which the elasticities are mixed alike.
struct ScenarioZone {
    bool stiff = false;                     ///< two thirds stiff; otherwise two thirds soft
    std::vector<std::uint32_t> tetrahedra;  ///< increasing indices, by barycentre
};

/// The zones of scenarios 1 to 8 in the bounding box of the mesh; z is up, the press comes along z.
/// Empty zones are left out. Throws bad_usage for another scenario.
std::vector<ScenarioZone> scenario_zones(const TetMesh& mesh, int scenario);

/// Number of stiff tetrahedra in a zone: two thirds (stiff zone) or one third (soft zone), rounded.
std::size_t stiff_count(const ScenarioZone& zone);

/// The material of one of the paper's nine scenarios.
///
/// Soft is uniform in 2-6 kPa, stiff uniform in 38-42 kPa, drawn per tetrahedron; the shares in each zone are
/// exact. Scenario 9 is uniform in 4-200 kPa everywhere. Figure 6 of the paper, which shows the layouts, is
/// not available: ours are inferred by fitting the forces of its Table 2 (docs/method.md).
///
/// The same mesh, scenario and seed give the same values on every platform.
/// @param scenario 1 to 9, otherwise bad_usage
/// Source: paper section 4, "Evaluation".
Material scenario_material(const TetMesh& mesh, int scenario, std::uint64_t seed, double poissons_ratio,
                           double density_kg_per_m3);

}  // namespace knead::tools
