// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "knead/formats/asset.h"
#include "knead/formats/numerics.h"

namespace knead::tools {

/// How hard an asset is to solve, told from its elasticities, masses and shapes alone.
struct Conditioning {
    Numerics numerics;  ///< contrasts, arithmetic and what the runtime would factor
    /// Stiffest over softest node that nothing holds or leads: largest over smallest bound of a node's
    /// diagonal block of K.
    double node_stiffness_spread = 1;
    /// Mean over the nodes that nothing holds or leads of stiffness over mass, 1/s^2: dt^2 times it says
    /// whether mass or stiffness rules a step.
    double stiffness_over_mass_per_s2 = 0;
    /// Shortest time in which a pressure wave crosses a tetrahedron along its smallest height.
    double fastest_crossing_s = 0;

    /// Whether mass outweighs stiffness in steps of `dt_s`.
    [[nodiscard]] bool mass_rules(double dt_s) const;
    /// What steps of `dt_s` will be preconditioned with: the sparse inverse where mass rules.
    [[nodiscard]] Preconditioner preconditioner_at(double dt_s) const;
};

/// Precondition: validate(asset).ok() and a free node.
[[nodiscard]] Conditioning condition_of(const Asset& asset);

}  // namespace knead::tools
