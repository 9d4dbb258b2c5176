// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/types.h"

namespace knead::core {

/// The rotation R nearest to a deformation gradient: the proper rotation that maximises tr(R^T F).
///
/// For det F > 0 it is the rotation of the polar decomposition; for an inverted tetrahedron it reflects the
/// direction of the smallest stretch, which lets the tetrahedron come back. The largest eigenvector of Horn's
/// symmetric 4 x 4 matrix (Horn 1987), by Jacobi rotations: robust, and some twenty times slower than the
/// Newton steps of the element pass, whose fallback it is. Identity if F is zero.
/// @pre F is finite
Quat nearest_rotation(const Mat& deformation_gradient) noexcept;

}  // namespace knead::core
