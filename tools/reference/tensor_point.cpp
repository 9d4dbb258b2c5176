// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/tensor_point.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <limits>

namespace knead::tools {
namespace {

// As in CorotationalPoint: below it R is not unique.
constexpr double kSmallestTurningStretch = 1e-9;
constexpr std::array<std::array<int, 2>, 6> kAxes{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};

Eigen::Matrix3d matrix_of_stress(const VoigtVector& stress) {
    Eigen::Matrix3d matrix;
    for (int k = 0; k < 6; ++k) {
        const auto& [i, j] = kAxes[static_cast<std::size_t>(k)];
        matrix(i, j) = matrix(j, i) = stress[k];
    }
    return matrix;
}

VoigtVector strain_of(const Eigen::Matrix3d& stretch) {
    VoigtVector strain;
    for (int k = 0; k < 6; ++k) {
        const auto& [i, j] = kAxes[static_cast<std::size_t>(k)];
        strain[k] = i == j ? stretch(i, i) - 1 : stretch(i, j) + stretch(j, i);
    }
    return strain;
}

}  // namespace

ElasticityTensor isotropic_tensor(double youngs_modulus_pa, double poissons_ratio) {
    const LameParameters lame = lame_parameters(youngs_modulus_pa, poissons_ratio);
    ElasticityTensor tensor = ElasticityTensor::Zero();
    tensor.topLeftCorner<3, 3>().setConstant(lame.lambda_pa);
    for (int k = 0; k < 3; ++k) {
        tensor(k, k) += 2 * lame.mu_pa;
        tensor(k + 3, k + 3) = lame.mu_pa;
    }
    return tensor;
}

TensorPoint::TensorPoint(const Eigen::Matrix3d& deformation_gradient, const ElasticityTensor& tensor_pa)
    : tensor_(tensor_pa) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(deformation_gradient,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    if (svd.info() != Eigen::Success) {
        right_ = rotation_ = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
        stretch_.setConstant(std::numeric_limits<double>::quiet_NaN());
        strain_.setConstant(std::numeric_limits<double>::quiet_NaN());
        return;
    }
    Eigen::Matrix3d left = svd.matrixU();
    right_ = svd.matrixV();
    stretch_ = svd.singularValues();
    for (Eigen::Matrix3d* side : {&left, &right_})
        if (side->determinant() < 0) {
            side->col(2) *= -1;
            stretch_[2] *= -1;
        }
    rotation_ = left * right_.transpose();
    strain_ = strain_of(right_ * stretch_.asDiagonal() * right_.transpose());
}

double TensorPoint::energy_density_j_per_m3() const {
    return strain_.dot(tensor_ * strain_) / 2;
}

/// With s the stress of the strain, in the frame of the stretches: a change A of F seen from R changes the
/// stretch by A - W diag(stretch), where W_ij = (A_ij - A_ji) / (stretch_i + stretch_j) is the turn of R.
/// What s does on that is sum_ij A_ij s_ij 2 stretch_i / (stretch_i + stretch_j).
Eigen::Matrix3d TensorPoint::stress_pa() const {
    Eigen::Matrix3d stress = right_.transpose() * matrix_of_stress(tensor_ * strain_) * right_;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            if (i == j) continue;
            const double sum = std::max(stretch_[i] + stretch_[j], kSmallestTurningStretch);
            stress(i, j) *= 2 * stretch_[i] / sum;
        }
    return rotation_ * right_ * stress * right_.transpose();
}

Matrix9d TensorPoint::frozen_tangent_pa() const {
    Eigen::Matrix<double, 6, 9> strain_of_gradient;
    for (int row = 0; row < 6; ++row) {
        const auto& [a, b] = kAxes[static_cast<std::size_t>(row)];
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k)
                strain_of_gradient(row, i + 3 * k) =
                    a == b ? (k == a ? rotation_(i, a) : 0)
                           : (k == b ? rotation_(i, a) : 0) + (k == a ? rotation_(i, b) : 0);
    }
    return strain_of_gradient.transpose() * tensor_ * strain_of_gradient;
}

}  // namespace knead::tools
