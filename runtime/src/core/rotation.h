// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/types.h"

namespace knead::core {

/// The rotation R nearest to a deformation gradient: the proper rotation that maximises tr(R^T F).
///
/// For det F > 0 it is the rotation of the polar decomposition; for an inverted tetrahedron it reflects the
/// direction of the smallest stretch, which lets the tetrahedron come back. Newton steps from a warm start
/// (Kugelstadt, Koschier, Bender 2018, "Fast Corotated FEM using Operator Splitting"), accepted only where
/// the second-order condition holds, because there the maximum is the global one; else nearest_rotation().
/// @param warm_start in: a unit quaternion, best that of the step before; out: the result (kept if F is not
/// finite)
Mat warm_rotation(const Mat& deformation_gradient, Quat& warm_start) noexcept;

/// The same without a warm start: the largest eigenvector of Horn's symmetric 4 x 4 matrix (Horn 1987), by
/// Jacobi rotations. Robust and some twenty times slower.
Quat nearest_rotation(const Mat& deformation_gradient) noexcept;

}  // namespace knead::core
