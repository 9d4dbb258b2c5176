// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/corotational.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace knead::tools {
namespace {

// Two singular values that sum to less than this (F mirrored in a plane): R is not unique there, and its
// derivative is cut so that the numbers stay finite.
constexpr double kSmallestTurningStretch = 1e-9;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

using Vector9d = Eigen::Matrix<double, 9, 1>;

Vector9d flattened(const Eigen::Matrix3d& matrix) {
    return Eigen::Map<const Vector9d>(matrix.data());
}

}  // namespace

LameParameters lame_parameters(double youngs_modulus_pa, double poissons_ratio) {
    return {youngs_modulus_pa / (2 * (1 + poissons_ratio)),
            youngs_modulus_pa * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio))};
}

CorotationalPoint::CorotationalPoint(const Eigen::Matrix3d& deformation_gradient, const LameParameters& lame)
    : deformation_gradient_(deformation_gradient), lame_(lame) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(deformation_gradient,
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    if (svd.info() != Eigen::Success) {  // F is not finite: so is everything that follows from it
        left_ = right_ = rotation_ = Eigen::Matrix3d::Constant(kNotANumber);
        singular_.setConstant(kNotANumber);
        dilation_ = kNotANumber;
        return;
    }
    left_ = svd.matrixU();
    right_ = svd.matrixV();
    singular_ = svd.singularValues();
    if (left_.determinant() < 0) {
        left_.col(2) *= -1;
        singular_[2] *= -1;
    }
    if (right_.determinant() < 0) {
        right_.col(2) *= -1;
        singular_[2] *= -1;
    }
    rotation_ = left_ * right_.transpose();
    dilation_ = singular_.sum() - 3;
}

double CorotationalPoint::energy_density_j_per_m3() const {
    const double stretching = (singular_ - Eigen::Vector3d::Ones()).squaredNorm();
    return lame_.mu_pa * stretching + lame_.lambda_pa / 2 * dilation_ * dilation_;
}

Eigen::Matrix3d CorotationalPoint::stress_pa() const {
    return 2 * lame_.mu_pa * (deformation_gradient_ - rotation_) + lame_.lambda_pa * dilation_ * rotation_;
}

/// What turns 2 mu dF into mu (dF + R dF^T R): only the symmetric part of R^T dF strains.
Matrix9d CorotationalPoint::symmetrised_strain_pa() const {
    Matrix9d result = -lame_.mu_pa * Matrix9d::Identity();
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b)
                    result(i + 3 * k, b + 3 * a) += lame_.mu_pa * rotation_(i, a) * rotation_(b, k);
    return result;
}

Matrix9d CorotationalPoint::tangent_pa(Curvature curvature) const {
    const double stretch_pa = 2 * lame_.mu_pa;
    Matrix9d tangent = stretch_pa * Matrix9d::Identity();
    const Vector9d rotation = flattened(rotation_);
    tangent += lame_.lambda_pa * rotation * rotation.transpose();
    if (curvature == Curvature::rotation_frozen) return tangent + symmetrised_strain_pa();
    for (int axis = 0; axis < 3; ++axis) {
        const int first = (axis + 1) % 3;
        const int second = (axis + 2) % 3;
        const Eigen::Matrix3d turn = (left_.col(second) * right_.col(first).transpose() -
                                      left_.col(first) * right_.col(second).transpose()) /
                                     std::sqrt(2.0);
        const double sum = std::max(singular_[first] + singular_[second], kSmallestTurningStretch);
        double turning_pa = (lame_.lambda_pa * dilation_ - stretch_pa) * 2 / sum;
        // The mode's eigenvalue is stretch_pa + turning_pa; all others are positive.
        if (curvature == Curvature::projected) turning_pa = std::max(turning_pa, -stretch_pa);
        const Vector9d mode = flattened(turn);
        tangent += turning_pa * mode * mode.transpose();
    }
    return tangent;
}

}  // namespace knead::tools
