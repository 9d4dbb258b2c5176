// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "reference/corotational.h"
#include "reference/elasticity_tensor.h"

namespace knead::tools {

/// CorotationalPoint for any linear elasticity: energy density 1/2 e C e, e = R^T F - I, R the rotation
/// nearest to F. With an isotropic C the two are the same.
class TensorPoint {
  public:
    TensorPoint(const Eigen::Matrix3d& deformation_gradient, const ElasticityTensor& tensor_pa);

    [[nodiscard]] double energy_density_j_per_m3() const;
    /// First Piola-Kirchhoff stress: the energy density's derivative to F, the turning of R included.
    [[nodiscard]] Eigen::Matrix3d stress_pa() const;
    /// The stress's derivative with R held as it is; positive semidefinite. Index i + 3 k as in
    /// CorotationalPoint.
    [[nodiscard]] Matrix9d frozen_tangent_pa() const;

  private:
    const ElasticityTensor& tensor_;
    Eigen::Matrix3d right_;    // F = R right_ diag(stretch_) right_^T
    Eigen::Vector3d stretch_;  // the last carries the sign of det F
    Eigen::Matrix3d rotation_;
    VoigtVector strain_;
};

}  // namespace knead::tools
