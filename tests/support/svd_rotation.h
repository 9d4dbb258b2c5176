// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>
#include <Eigen/SVD>

namespace knead::test {

/// Oracle: the proper rotation nearest to F by Eigen's SVD.
/// @param gap how far the nearest rotation is ahead of the second: its condition is the inverse of it
inline Eigen::Matrix3d svd_rotation(const Eigen::Matrix3d& f, double* gap = nullptr) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d sign = Eigen::Vector3d::Ones();
    if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
    if (gap != nullptr) *gap = svd.singularValues()[1] + sign.z() * svd.singularValues()[2];
    return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace knead::test
