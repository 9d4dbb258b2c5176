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

/// A connected part of the object that nothing holds: its momentum and its spin are its own.
struct LoosePart {
    std::vector<std::uint32_t> nodes;  ///< ascending
    Real mass_kg = 0;
};

/// The constant data of one object: what the asset says, in the form that steps use.
///
/// Nodes are numbered anew: [0, free_count) are unknowns, in the asset's (nested-dissection) order; those of
/// bonded tool k stand in bonded[k]; the rest are fixed. Built once; read by everything, changed by nothing.
struct Model {
    struct Range {
        std::uint32_t begin = 0, end = 0;
    };

    std::vector<Element> elements;
    Field rest_m;               ///< [nodes]
    std::vector<Real> mass_kg;  ///< [nodes] a quarter of each tetrahedron's mass to each of its nodes
    std::uint32_t free_count = 0;
    std::uint32_t moving_count = 0;  ///< free ones and those of bonded tools
    std::vector<Range> bonded;       ///< [tools] nodes that the tool carries; empty unless it is bonded
    std::vector<std::uint32_t> from_asset;  ///< [nodes] number here of each node of the asset
    std::vector<LoosePart> loose_parts;     ///< mostly none
    Real free_mass_kg = 0;                  ///< of the free nodes together
    Real mean_edge_m = 0;                   ///< of a regular tetrahedron of the mean volume
    Real size_m = 0;                        ///< diagonal of the rest state's bounding box
    Vec gravity_m_per_s2 = Vec::Zero();
    Real damping_per_s = 0;  ///< mass-proportional
};

/// @param asset valid (validate() said so)
/// @param tools the asset's tools that are simulated, by index
Model build_model(const Asset& asset, const std::vector<std::size_t>& tools);

/// The simulated tools, their nodes numbered as in the model, ascending.
std::vector<ToolSet> renumbered(const Asset& asset, const std::vector<std::size_t>& tools,
                                const Model& model);

/// The free nodes that unilateral tools may hold, ascending.
std::vector<std::uint32_t> touchable(const Asset& asset, const std::vector<std::size_t>& tools,
                                     const Model& model);

}  // namespace knead::core
