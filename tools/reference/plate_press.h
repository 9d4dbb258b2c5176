// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "reference/static_problem.h"

namespace knead::tools {

/// How the upper plate touches the object.
enum class PlateSlip : std::uint8_t {
    none,  ///< its nodes follow the plate along all axes: what fits the paper's figures best
    free   ///< its nodes follow the plate along z only
};

/// The paper's press of a box that stands along z: lowest nodes held, highest nodes moved down.
struct PlatePress {
    PrescribedMotion motion;  ///< held nodes first, then the plate's
    std::vector<std::uint32_t> held_nodes;
    std::vector<std::uint32_t> plate_nodes;
    double height_m = 0;
    double area_m2 = 0;  ///< of the box's cross-section: extent along x times extent along y
};

/// Nodes within 1e-9 of the box's height of its lowest and highest z count as held and as touched.
/// @param strain share of the height that the plate moves down, finite and below 1
/// @throws ToolError(bad_input) for a bad strain or a mesh without height
[[nodiscard]] PlatePress plate_press(const TetMesh& mesh, double strain, PlateSlip slip = PlateSlip::none);

/// Force of the object on the upper plate, newtons; z is positive when it pushes the plate back up.
[[nodiscard]] Point force_on_plate_n(const PlatePress& press, const StaticSolution& solution);

}  // namespace knead::tools
