// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "knead/formats/tet_mesh.h"
#include "quality/tet_shape.h"

namespace knead::tools {

/// Tetrahedra below this radius ratio are named as slivers: they make a simulation slow and lock what is
/// around them.
inline constexpr double kSliverRadiusRatio = 0.05;
/// Tetrahedra thinner than this are turned inside out by the strain of a light touch.
inline constexpr double kInvertedByStrain = 0.01;
/// Soft objects that one touches by hand are larger and smaller than these: beyond, a unit is wrong.
inline constexpr double kLargestLikelyExtent_m = 10;
inline constexpr double kSmallestLikelyExtent_m = 1e-4;
/// How many of the worst tetrahedra are named.
inline constexpr std::size_t kWorstNamed = 8;

/// One of the worst tetrahedra.
struct WorstTetrahedron {
    std::uint32_t tetrahedron = 0;  ///< its position in the mesh, from 0
    Point middle_m{};               ///< its barycentre
    TetShape shape;
};

/// Shape of the tetrahedra of a mesh, and how they hang together.
struct MeshQuality {
    double volume_m3 = 0;
    double min_radius_ratio = 0;
    double mean_radius_ratio = 0;
    double min_mean_ratio = 0;
    double mean_mean_ratio = 0;
    double min_dihedral_deg = 0;
    double max_dihedral_deg = 0;
    double shortest_edge_m = 0;
    double longest_edge_m = 0;
    double mean_edge_m = 0;  ///< over the tetrahedra
    /// [k] tetrahedra with a radius ratio in [k / 10, (k + 1) / 10); the last one takes 1 too.
    std::array<std::uint64_t, 10> radius_ratio_histogram{};
    /// [k] tetrahedra whose sharpest dihedral angle is in [10 k, 10 (k + 1)) degrees; it is 70.53 at most.
    std::array<std::uint64_t, 8> min_dihedral_histogram{};
    std::vector<WorstTetrahedron> worst;       ///< the kWorstNamed of lowest radius ratio, worst first
    std::vector<std::uint32_t> slivers;        ///< positions of those below kSliverRadiusRatio
    std::vector<std::uint32_t> near_inverted;  ///< positions of those below kInvertedByStrain
    std::uint32_t bodies = 0;                  ///< parts that share no node
    Point low_m{};                             ///< bounding box
    Point high_m{};

    /// Longest edge of the bounding box.
    [[nodiscard]] double extent_m() const;
};

/// Precondition: the mesh is valid.
[[nodiscard]] MeshQuality measure(const TetMesh& mesh);

}  // namespace knead::tools
