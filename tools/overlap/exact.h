// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "overlap/prepared_tet.h"

namespace knead::tools {

// Exact rational arithmetic, for the few tetrahedra and pairs that floating point cannot do with certainty.
// The only file that includes CGAL is exact.cpp: it is slow to compile and slow to run (~0.1 ms a pair).

/// Share of tetrahedron a's volume that lies inside tetrahedron b, rounded once.
[[nodiscard]] double exact_share(const Corners& a, const Corners& b);

/// Volume of a tetrahedron, rounded once.
[[nodiscard]] double exact_volume(const Corners& corners);

/// "CGAL 5.5.1"
[[nodiscard]] std::string exact_library_version();

}  // namespace knead::tools
