// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluate/level_mesh.h"
#include "knead/formats/material.h"

namespace knead::tools {

/// Ways to give a coarse mesh the elasticity of a fine object. docs/evaluation.md says where each is from.
enum class MethodKind : std::uint8_t {
    homogenised,   ///< one volume-weighted mean everywhere
    paper,         ///< elasticity bins, clusters, aggregation, dominant bin
    raw_dominant,  ///< the fine tetrahedron that fills most of the coarse one
    voigt,         ///< volume-weighted arithmetic mean [NPF06]
    reuss,         ///< harmonic mean
    geometric,     ///< geometric mean
    hill,          ///< middle of Voigt and Reuss
    kmod09,        ///< a full elasticity tensor per tetrahedron [KMOD09]; not for the runtime
    iycn13,        ///< a coarse mesh whose planes follow the elasticities [IYCN13], volume average on it
    calibrated     ///< fitted to probes of the fine object (method.md, section 5)
};

/// Names in the order of the tables: homogenised paper raw-dominant voigt reuss geometric hill kmod09 iycn13
/// calibrated.
[[nodiscard]] const std::vector<std::string>& method_names();
[[nodiscard]] const std::string& name_of(MethodKind kind);

/// A method with its numbers.
struct Method {
    MethodKind kind = MethodKind::paper;
    std::uint32_t bins = 0;      ///< paper; homogenised: 1; else 0
    std::uint32_t clusters = 0;  ///< paper; homogenised: 1; else 0

    /// Whether the seed of k-means changes what it gives.
    [[nodiscard]] bool uses_seed() const { return kind == MethodKind::paper; }
    /// "paper 2x3", "voigt"
    [[nodiscard]] std::string text() const;
    bool operator==(const Method&) const = default;
};

/// Weighted mean of E over the fine tetrahedra in each coarse one, all of them from one formula:
/// voigt sum(w E), reuss 1 / sum(w / E), geometric exp(sum(w log E)), hill (voigt + reuss) / 2, with w the
/// share of the covered volume. Poisson's ratio and density are volume averages.
/// @param kind voigt, reuss, geometric or hill
[[nodiscard]] Material mean_material(MethodKind kind, const MaterialObject& fine, const LevelMesh& level);

/// Bins, clusters and aggregation of the fine object (phases P1 to P3), stiff first; one bin and one cluster
/// is the homogenised object.
[[nodiscard]] Material aggregated_material(const MaterialObject& fine, std::uint32_t bins,
                                           std::uint32_t clusters, std::uint64_t seed);

/// Material of the level's mesh by a method that leaves the mesh as it is and has isotropic elasticities:
/// all but kmod09, iycn13 and calibrated.
/// @param seed of k-means
[[nodiscard]] Material simple_material(const Method& method, const MaterialObject& fine,
                                       const LevelMesh& level, std::uint64_t seed);

}  // namespace knead::tools
