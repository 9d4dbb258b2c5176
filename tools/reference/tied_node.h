// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// A node that others carry along: its displacement is `displacement_m` plus the weighted sum of theirs, in
/// each axis.
///
/// What lies between the nodes of a tool's border: the tool's motion less the masters' share of it as
/// `displacement_m` holds the surface to the tool on average (evaluate/loads.h).
/// Invariants: neither prescribed nor a master of another tied node; masters unique, weights finite.
struct TiedNode {
    std::uint32_t node = 0;
    std::vector<std::pair<std::uint32_t, double>> masters;
    Point displacement_m{};
};

}  // namespace knead::tools
