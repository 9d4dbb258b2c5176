// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/types.h"
#include "knead/formats/asset.h"

namespace knead::core {

/// What a step needs to know of one tetrahedron; never changes.
struct Element {
    std::array<std::uint32_t, 4> nodes{};
    /// Inverse of [x1 - x0, x2 - x0, x3 - x0] at rest, 1/m: row k is the gradient of node k + 1's shape
    /// function.
    Mat rest_inverse = Mat::Zero();
    Real mu_volume = 0;      ///< Lame's mu times the rest volume, joules
    Real lambda_volume = 0;  ///< Lame's lambda times the rest volume, joules
};

/// The constant data of one object: what the asset says, in the form that steps use.
///
/// Nodes in asset order; [0, free_count) move. Built once; read by everything, changed by nothing.
struct Model {
    std::vector<Element> elements;
    Field rest_m;               ///< [nodes]
    std::vector<Real> mass_kg;  ///< [nodes] a quarter of each tetrahedron's mass to each of its nodes
    std::uint32_t free_count = 0;
    Real free_mass_kg = 0;  ///< of the free nodes together
    Real size_m = 0;        ///< diagonal of the rest state's bounding box
    Vec gravity_m_per_s2 = Vec::Zero();
    Real damping_per_s = 0;  ///< mass-proportional
};

/// @param asset valid (validate() said so)
Model build_model(const Asset& asset);

}  // namespace knead::core
