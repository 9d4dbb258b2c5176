// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "bake/bake.h"
#include "knead/formats/asset.h"
#include "knead/formats/material.h"

namespace knead::bench {

inline constexpr double kSideM = 0.1;
inline constexpr double kDensityKgPerM3 = 1000;  ///< 1 kg
inline constexpr double kPoissonsRatio = 0.3;
inline constexpr std::uint64_t kSeed = 1;

/// The paper's cube of cells^3 Kuhn cells under scenario 1.
[[nodiscard]] MaterialObject scenario_cube(std::uint32_t cells, double poissons_ratio = kPoissonsRatio);

/// Where the stiff matter of a cube of two materials lies.
enum class Layout : std::uint8_t {
    percolating,  ///< half of the tetrahedra, drawn at random: paths of stiff matter from face to face
    islands       ///< cells that share no node with one another nor with the border, 5 % of the volume
};

/// A cube of soft matter (4 kPa) with stiff matter of `contrast` times its elasticity.
[[nodiscard]] MaterialObject contrast_cube(std::uint32_t cells, double poissons_ratio, double contrast,
                                           Layout layout);

/// The press: lowest nodes held, highest bonded to a plate. No gravity, damping or surface.
[[nodiscard]] tools::Scene press_scene();

/// The asset as knead-bake makes it.
[[nodiscard]] Asset bake_scene(const tools::Scene& scene, const MaterialObject& object,
                               const tools::Skin& skin = {});

}  // namespace knead::bench
