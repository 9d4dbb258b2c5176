// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "overlap/clip.h"
#include "overlap/prepared_tet.h"

namespace knead::tools {

/// Values of the planes of `faces` at `corners`: [corner][face], positive inside. The value at the opposite
/// corner of the same tetrahedron is six times its volume.
template <class Number>
Piece<Number> plane_values(const Corners& corners, const Faces<Number>& faces) {
    Piece<Number> values;
    for (int corner = 0; corner < 4; ++corner)
        for (int face = 0; face < 4; ++face) {
            const Number x = Number(corners[corner][0]) - faces.origin[0][face];
            const Number y = Number(corners[corner][1]) - faces.origin[1][face];
            const Number z = Number(corners[corner][2]) - faces.origin[2][face];
            values[corner][face] =
                faces.normal[0][face] * x + faces.normal[1][face] * y + faces.normal[2][face] * z;
        }
    return values;
}

}  // namespace knead::tools
