// SPDX-License-Identifier: Apache-2.0
#include "reference/corotational.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <vector>

namespace knead::tools {
namespace {

constexpr double kStep = 1e-6;  // of a finite difference: error of order step^2 and epsilon / step
// Central differences at kStep leave about 1e-10 of the modulus; ten times that is still far below any
// mistake.
constexpr double kDifferenceTolerance = 1e-8;
constexpr double kRounding = 1e-12;  // a few hundred operations in double

const LameParameters kLame = lame_parameters(1.0, 0.3);

/// Uniform in [-1, 1), the same on every platform.
double uniform(std::mt19937_64& bits) {
    return static_cast<double>(bits() >> 11) * 0x1p-52 - 1;
}

Eigen::Matrix3d random_matrix(std::mt19937_64& bits) {
    Eigen::Matrix3d matrix;
    for (int k = 0; k < 9; ++k)
        matrix(k) = uniform(bits);
    return matrix;
}

Eigen::Matrix3d rotation(double angle, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// Deformations of every kind, away from those where R is not unique.
std::vector<Eigen::Matrix3d> deformations() {
    std::mt19937_64 bits(7);
    const Eigen::Matrix3d turned = rotation(2.1, {1, -2, 0.5});
    std::vector<Eigen::Matrix3d> result{Eigen::Matrix3d::Identity(), turned};
    result.push_back(turned * Eigen::Vector3d(0.5, 0.8, 1.7).asDiagonal());
    result.push_back(turned * Eigen::Vector3d(1.1, 0.9, -0.3).asDiagonal() * rotation(1, {0, 1, 2}));
    for (int k = 0; k < 20; ++k)
        result.push_back(rotation(3 * uniform(bits), {1, uniform(bits), uniform(bits)}) +
                         0.3 * random_matrix(bits));
    return result;
}

TEST(Corotational, Lame_parameters_give_back_the_moduli_of_the_uniaxial_test) {
    const double mu = kLame.mu_pa;
    const double lambda = kLame.lambda_pa;
    EXPECT_NEAR(mu * (3 * lambda + 2 * mu) / (lambda + mu), 1.0, kRounding);
    EXPECT_NEAR(lambda / (2 * (lambda + mu)), 0.3, kRounding);
}

TEST(Corotational, Rotation_of_any_deformation_is_proper_and_the_nearest_of_many) {
    std::mt19937_64 bits(11);
    for (const Eigen::Matrix3d& F : deformations()) {
        const Eigen::Matrix3d R = CorotationalPoint(F, kLame).rotation();
        EXPECT_NEAR((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 0, kRounding);
        EXPECT_NEAR(R.determinant(), 1, kRounding);
        for (int k = 0; k < 50; ++k) {
            const Eigen::Matrix3d other =
                R * rotation(3 * uniform(bits), {uniform(bits), uniform(bits), uniform(bits)});
            EXPECT_LE((F - R).norm(), (F - other).norm() + kRounding);
        }
    }
}

TEST(Corotational, Energy_and_stress_of_a_deformation_follow_the_closed_form) {
    for (const Eigen::Matrix3d& F : deformations()) {
        const CorotationalPoint point(F, kLame);
        const Eigen::Matrix3d R = point.rotation();
        const double dilation = (R.transpose() * F).trace() - 3;
        EXPECT_NEAR(point.energy_density_j_per_m3(),
                    kLame.mu_pa * (F - R).squaredNorm() + kLame.lambda_pa / 2 * dilation * dilation,
                    kRounding);
        const Eigen::Matrix3d stress = 2 * kLame.mu_pa * (F - R) + kLame.lambda_pa * dilation * R;
        EXPECT_NEAR((point.stress_pa() - stress).norm(), 0, kRounding);
    }
}

TEST(Corotational, Energy_and_stress_of_a_rotation_are_zero) {
    const CorotationalPoint point(rotation(2.9, {0.2, 1, -1}), kLame);
    EXPECT_NEAR(point.energy_density_j_per_m3(), 0, kRounding);
    EXPECT_NEAR(point.stress_pa().norm(), 0, kRounding);
}

TEST(Corotational, Stress_is_the_energy_s_derivative_by_finite_differences) {
    for (const Eigen::Matrix3d& F : deformations()) {
        const Eigen::Matrix3d stress = CorotationalPoint(F, kLame).stress_pa();
        for (int k = 0; k < 9; ++k) {
            Eigen::Matrix3d above = F;
            Eigen::Matrix3d below = F;
            above(k) += kStep;
            below(k) -= kStep;
            const double slope = (CorotationalPoint(above, kLame).energy_density_j_per_m3() -
                                  CorotationalPoint(below, kLame).energy_density_j_per_m3()) /
                                 (2 * kStep);
            EXPECT_NEAR(stress(k), slope, kDifferenceTolerance);
        }
    }
}

TEST(Corotational, Exact_tangent_is_the_stress_s_derivative_by_finite_differences) {
    for (const Eigen::Matrix3d& F : deformations()) {
        const Matrix9d tangent = CorotationalPoint(F, kLame).tangent_pa(Curvature::exact);
        for (int k = 0; k < 9; ++k) {
            Eigen::Matrix3d above = F;
            Eigen::Matrix3d below = F;
            above(k) += kStep;
            below(k) -= kStep;
            const Eigen::Matrix3d slope =
                (CorotationalPoint(above, kLame).stress_pa() - CorotationalPoint(below, kLame).stress_pa()) /
                (2 * kStep);
            const Eigen::Map<const Eigen::Matrix<double, 9, 1>> column(slope.data());
            EXPECT_NEAR((tangent.col(k) - column).norm(), 0, kDifferenceTolerance * (1 + column.norm()));
        }
    }
}

TEST(Corotational, Projected_tangent_keeps_the_positive_eigenvalues_and_drops_the_others) {
    bool was_indefinite = false;
    for (const Eigen::Matrix3d& F : deformations()) {
        const CorotationalPoint point(F, kLame);
        const Eigen::SelfAdjointEigenSolver<Matrix9d> exact(point.tangent_pa(Curvature::exact));
        was_indefinite = was_indefinite || exact.eigenvalues().minCoeff() < -kDifferenceTolerance;
        const Matrix9d nearest = exact.eigenvectors() * exact.eigenvalues().cwiseMax(0).asDiagonal() *
                                 exact.eigenvectors().transpose();
        EXPECT_NEAR((point.tangent_pa(Curvature::projected) - nearest).norm(), 0, kDifferenceTolerance);
    }
    EXPECT_TRUE(was_indefinite) << "the deformations must put the projection to work";
}

TEST(Corotational, Deformation_that_is_not_finite_gives_an_energy_that_is_not_finite) {
    const CorotationalPoint point(Eigen::Matrix3d::Constant(std::nan("")), kLame);
    EXPECT_FALSE(std::isfinite(point.energy_density_j_per_m3()));
}

}  // namespace
}  // namespace knead::tools
