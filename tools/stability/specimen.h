// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "knead/formats/asset.h"
#include "knead/formats/material.h"
#include "reference/static_problem.h"
#include "scene/scene.h"

namespace knead::tools::stability {

/// The cube of most cells: side, Young's modulus, Poisson's ratio and density where a cell does not say.
inline constexpr double kSide_m = 0.1;
inline constexpr double kYoungsModulus_pa = 10e3;
inline constexpr double kPoissonsRatio = 0.3;
inline constexpr double kDensity_kg_per_m3 = 1000;
inline constexpr std::uint32_t kCells = 4;  ///< along an edge: 384 tetrahedra

/// What an object is made of.
struct Matter {
    double youngs_modulus_pa = kYoungsModulus_pa;
    double poissons_ratio = kPoissonsRatio;
    double density_kg_per_m3 = kDensity_kg_per_m3;
};

/// What acts on the object of a cell.
struct Setting {
    bool held_bottom = true;
    bool damped = true;  ///< critically, for its slowest wave: so that there is a rest to compare with
    Point gravity_m_per_s2{};
    std::vector<SceneTool> tools;
};

/// An object for the runtime and for the reference: one asset, read by both.
struct Specimen {
    Asset asset;
    TetMesh mesh;       ///< the asset's nodes and tetrahedra
    Material material;  ///< of these
    PrescribedMotion held;
    double size_m = 0;               ///< largest extent
    double shear_speed_m_per_s = 0;  ///< in the softest matter

    /// Time in which a critically damped object comes to rest (criteria.h).
    [[nodiscard]] double settle_s() const;
};

[[nodiscard]] MaterialObject homogeneous(TetMesh mesh, const Matter& matter = {});

/// A plate over the whole upper side, bonded.
[[nodiscard]] SceneTool bonded_plate();
/// A plate, a ball of 0.4 or a capsule of 0.3 sides radius above the middle of the upper side of a box that
/// is `side_m` wide, just touching.
[[nodiscard]] SceneTool tool_above(ToolShape shape, ToolContact contact, double side_m = kSide_m);
/// The nodes of one side of the box.
[[nodiscard]] Selection side_of_box(const char* side);

/// Baked as knead-bake does it. @throws ToolError as bake()
[[nodiscard]] Specimen make_specimen(const MaterialObject& object, const Setting& setting);
/// An asset that was not baked.
[[nodiscard]] Specimen specimen_of(Asset asset);

/// The cube of most cells under a bonded plate.
[[nodiscard]] Specimen plain_cube(const Matter& matter = {}, std::uint32_t cells = kCells,
                                  double side_m = kSide_m);

}  // namespace knead::tools::stability
