// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace knead::tools {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// Lamé's parameters of an isotropic material, pascals.
struct LameParameters {
    double mu_pa = 0;
    double lambda_pa = 0;
};

/// @pre youngs_modulus_pa > 0 and -1 < poissons_ratio < 0.5
[[nodiscard]] LameParameters lame_parameters(double youngs_modulus_pa, double poissons_ratio);

/// Which second derivative of the energy is wanted.
enum class Curvature {
    exact,      ///< includes the turning of R; may be indefinite under compression
    projected,  ///< its negative eigenvalues replaced by zero: the nearest positive semidefinite matrix
    /// R held as it is: R K0 R^T with K0 of linear elasticity, the classical corotational stiffness that one
    /// step of the runtime solves with. Positive semidefinite.
    rotation_frozen
};

/// The corotational material at one deformation gradient F.
///
/// Energy density: mu |F - R|^2 + lambda/2 tr(R^T F - I)^2, with R the rotation nearest to F. Its gradient is
/// the classical corotational force R K0 (R^T x - X) of linear tetrahedra. R comes from a singular value
/// decomposition whose smallest value changes sign with det F, so it is a rotation under inversion too.
/// Second derivative in closed form: turning modes in the plane of two singular directions (Smith, de Goes,
/// Kim: Analytic Eigensystems for Isotropic Distortion Energies, 2019).
/// Source: paper section 3.1, [MG04].
class CorotationalPoint {
  public:
    CorotationalPoint(const Eigen::Matrix3d& deformation_gradient, const LameParameters& lame);

    [[nodiscard]] const Eigen::Matrix3d& rotation() const { return rotation_; }
    [[nodiscard]] double energy_density_j_per_m3() const;
    /// First Piola-Kirchhoff stress: the energy density's derivative to F.
    [[nodiscard]] Eigen::Matrix3d stress_pa() const;
    /// Derivative of the stress to F; entry (i, k) of a 3x3 matrix has index i + 3 k.
    [[nodiscard]] Matrix9d tangent_pa(Curvature curvature) const;

  private:
    [[nodiscard]] Matrix9d symmetrised_strain_pa() const;

    Eigen::Matrix3d deformation_gradient_;
    LameParameters lame_;
    Eigen::Matrix3d left_, right_;  // F = left_ diag(singular_) right_^T, both rotations
    Eigen::Vector3d singular_;      // decreasing; the last carries the sign of det F
    Eigen::Matrix3d rotation_;
    double dilation_;  // tr(R^T F - I)
};

}  // namespace knead::tools
