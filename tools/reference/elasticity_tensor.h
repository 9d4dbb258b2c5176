// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace knead::tools {

/// Stress of strain, pascals: (xx, yy, zz, yz, xz, xy) of (xx, yy, zz, 2 yz, 2 xz, 2 xy).
/// Unaligned: it goes into plain vectors.
using ElasticityTensor = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;
/// A strain in the same order, shears doubled; or a stress, shears plain.
using VoigtVector = Eigen::Matrix<double, 6, 1>;

[[nodiscard]] ElasticityTensor isotropic_tensor(double youngs_modulus_pa, double poissons_ratio);

}  // namespace knead::tools
