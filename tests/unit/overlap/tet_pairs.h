// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iosfwd>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "unit/overlap/exact_oracle.h"

namespace knead::test {

using TetPair = std::pair<Corners, Corners>;

/// Families of pairs of tetrahedra of positive volume, each made to be awkward in its own way.
enum class PairKind {
    random,
    different_size,
    inside,
    identical,
    shared_face,
    shared_edge,
    shared_vertex,
    coplanar_lattice,  ///< corners on a 4 x 4 x 4 lattice of inexact coordinates: every way to touch
    nearly_coplanar,   ///< the same, each coordinate moved by a few units in the last place
    sliver,            ///< flattened by 1e-1 to 1e-12
    thin_overlap,      ///< one pushed into the other's face by 1e-1 to 1e-15
    tiny,
    far_from_origin,
};

[[nodiscard]] std::vector<PairKind> all_pair_kinds();
[[nodiscard]] std::string name_of(PairKind kind);
void PrintTo(PairKind kind, std::ostream* stream);  ///< for gtest

/// The same pairs on every machine.
[[nodiscard]] std::vector<TetPair> make_pairs(PairKind kind, int count);

}  // namespace knead::test
