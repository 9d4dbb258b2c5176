// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "knead/formats/material.h"
#include "material/sources.h"

namespace knead::tools {

/// What a user asks knead-material for: exactly one source of elasticities, and values for what it leaves
/// open.
struct MaterialRequest {
    std::optional<double> uniform_pa;
    std::optional<int> scenario;
    std::optional<std::vector<RegionValues>> regions;
    std::optional<std::string> array;
    bool from_mesh = false;
    std::optional<ValueTable> table;
    std::optional<std::string> expression;

    std::uint64_t seed = 1;                ///< of the scenario
    std::optional<double> poissons_ratio;  ///< default: MaterialDefaults
    std::optional<double> density_kg_per_m3;
    std::optional<double> total_mass_kg;  ///< instead of a density
};

struct MaterialAnswer {
    Material material;
    /// Every option that changes the result, defaults included.
    std::vector<std::string> canonical_arguments;
    bool used_seed = false;
};

/// Makes the material that was asked for and checks that a solid can have it.
/// @throws bad_usage for values and combinations of the request itself; bad_input for what the mesh or the
///         source does not allow
[[nodiscard]] MaterialAnswer make_material(const TetMesh& mesh, const MaterialRequest& request);

}  // namespace knead::tools
