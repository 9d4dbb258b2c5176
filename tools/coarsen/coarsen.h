// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "knead/formats/material.h"
#include "knead/formats/overlap.h"

namespace knead::tools {

/// How a coarse tetrahedron gets its values from the fine ones that it overlaps.
enum class CoarsenRule : std::uint8_t {
    dominant,        ///< the values that fill most of it; ties: the stiffer. Keeps the few elasticities
    volume_average,  ///< the volume-weighted mean (Voigt); every coarse tetrahedron its own values, no bins
};

/// How well the two meshes cover each other. Shares are of volumes.
struct CoveredShares {
    double coarse_share = 0;                      ///< of the coarse mesh that lies in the fine one
    double fine_share = 0;                        ///< of the fine mesh that lies in the coarse one
    std::vector<std::uint32_t> coarse_missing;    ///< coarse tetrahedra that miss more than 1 %
    std::vector<std::uint32_t> fine_missing;      ///< fine tetrahedra that miss more than 1 %
    std::vector<std::uint32_t> coarse_uncovered;  ///< coarse tetrahedra without any overlap
};

struct CoarsenResult {
    Material material;  ///< of the coarse mesh
    CoveredShares coverage;
};

/// Phase P4: values of the coarse tetrahedra from the overlap with the fine ones.
///
/// dominant compares summed volumes per bin; without bins, per group of tetrahedra with the very same values.
/// Both rules look at the covered volume only. A coarse tetrahedron without overlap takes the values of the
/// fine tetrahedron with the nearest barycentre.
/// @param fine valid mesh and material
/// @throws bad_input when the overlap's counts are not those of the meshes, or when it gives a tetrahedron
/// more
///         volume than it has: the overlap is of other meshes
/// Source: paper section 3.2, "Geometric coarsening"; the average is [NPF06]'s.
[[nodiscard]] CoarsenResult coarsen(const MaterialObject& fine, const TetMesh& coarse,
                                    const OverlapMatrix& overlap, CoarsenRule rule);

}  // namespace knead::tools
