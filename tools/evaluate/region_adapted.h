// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "knead/formats/material.h"
#include "scene/scene.h"

namespace knead::tools {

/// Cuts [0, 1] into `parts` intervals, none narrower than half of an equal share, so that a profile varies as
/// little as possible inside of them; where it does not say, the intervals are equal.
///
/// Exact over multiples of 1/120 (which has the borders of 10, 8, 6 and 3 equal parts among them): smallest
/// sum of the variance inside the intervals and a small penalty on unequal widths.
/// @param profile values of equal steps along [0, 1], not empty
/// @return parts + 1 increasing numbers from 0 to 1
[[nodiscard]] std::vector<double> cut_profile(const std::vector<double>& profile, std::uint32_t parts);

/// The level's mesh of cubes with its planes moved to where the elasticity changes: along each axis, the
/// profile is the mean of log E over the layers of the fine mesh.
///
/// In the spirit of S. Imai, Y. Yue, B.-Y. Chen, T. Nishita: Adaptively simulating inhomogeneous elastic
/// deformation, GRAPP 2013: a coarse mesh of the same size whose elements are as homogeneous as can be.
/// Theirs is an adaptive mesh; moving planes is what a mesh of cubes allows without changing its number of
/// elements.
/// @pre both sources are of kind "cubes"
[[nodiscard]] TetMesh region_adapted_mesh(const MaterialObject& fine, const MeshSource& fine_source,
                                          const MeshSource& level_source);

}  // namespace knead::tools
