// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

namespace knead::tools {

/// How close to the wanted number of tetrahedra is close enough, and how often to mesh for it.
inline constexpr double kCountTolerance = 0.03;
inline constexpr int kMaxMeshings = 16;

struct SizeSearchResult {
    double edge_length = 0;  ///< the one whose count is nearest to the wanted one
    std::size_t count = 0;
    int meshings = 0;
    bool within_tolerance = false;
};

/// Finds the edge length that gives about `wanted` tetrahedra.
/// @param count_at meshes with an edge length and says how many tetrahedra that makes; falls, roughly, as the
///        third power of the edge length, but in jumps. It may change the edge length to the one it used.
/// @param first_guess any positive length near the size of the object; a coarse one is cheap
/// Deterministic; at most kMaxMeshings calls.
[[nodiscard]] SizeSearchResult search_edge_length(std::size_t wanted, double first_guess,
                                                  const std::function<std::size_t(double&)>& count_at);

}  // namespace knead::tools
