// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "overlap/prepared_tet.h"

namespace knead::tools {

/// Accuracy promised by shared_volume(), relative to the volume of the smaller tetrahedron.
inline constexpr double kSharedVolumeAccuracy = 1e-12;

/// How many pairs needed which arithmetic; for reports and tests.
struct ArithmeticCounts {
    std::uint64_t in_double = 0;
    std::uint64_t in_long_double = 0;
    std::uint64_t exact = 0;

    ArithmeticCounts& operator+=(const ArithmeticCounts& other) {
        in_double += other.in_double;
        in_long_double += other.in_long_double;
        exact += other.exact;
        return *this;
    }
};

/// Volume common to two tetrahedra, within kSharedVolumeAccuracy of the smaller one's volume whatever their
/// shapes, sizes and positions (both within one exponent range, see prepare()).
///
/// The smaller one is cut by the face planes of the larger one (clip.h). Only the plane values at the corners
/// carry errors worth speaking of. They are bounded (a forward error analysis of the determinant) and the
/// bound is carried to the volume: between two parallel planes a distance d apart lies at most 3 d / w of a
/// tetrahedron of width w. Where that bound is not small enough the pair is done again in long double, and
/// where that is not enough in exact rational arithmetic (CGAL).
/// @return 0, or a volume that is certainly shared: pairs that only touch share 0
[[nodiscard]] double shared_volume(const PreparedTet& a, const PreparedTet& b, ArithmeticCounts& counts);

}  // namespace knead::tools
