// SPDX-License-Identifier: Apache-2.0
#include "core/rotation.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <random>

namespace knead::core {
namespace {

/// Newton stops below a turn of 1e-6 and is then exact to its square; the SVD itself is good to 1e-14.
constexpr double kAngleTolerance = 1e-10;

/// Oracle: the proper rotation nearest to F by Eigen's SVD; shares nothing with the code under test.
Mat svd_rotation(const Mat& f, double* gap = nullptr) {
    const Eigen::JacobiSVD<Mat> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec sign = Vec::Ones();
    if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
    if (gap != nullptr) *gap = svd.singularValues()[1] + sign.z() * svd.singularValues()[2];
    return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
    }
    Mat matrix(double size) {
        Mat m;
        for (int i = 0; i < 9; ++i)
            m(i) = uniform(-size, size);
        return m;
    }
    Quat rotation() {
        Quat q(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        q.normalize();
        return q;
    }

  private:
    std::mt19937_64 engine_;
};

TEST(WarmRotation, of_random_matrices_from_random_starts_equals_the_svd) {
    Random random(1);
    int checked = 0;
    for (int i = 0; i < 20000; ++i) {
        const Mat f = random.matrix(2);  // half of them inverted
        double gap = 0;
        const Mat expected = svd_rotation(f, &gap);
        if (gap < 1e-3) continue;  // two rotations equally near: not defined
        Quat start = random.rotation();
        EXPECT_LT((warm_rotation(f, start) - expected).norm(), kAngleTolerance) << f;
        EXPECT_LT((start.toRotationMatrix() - expected).norm(), kAngleTolerance);
        ++checked;
    }
    EXPECT_GT(checked, 19000);
}

TEST(WarmRotation, after_a_small_move_of_an_inverted_element_equals_the_svd) {
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
        const Mat turn = random.rotation().toRotationMatrix();
        const Mat f = turn * Vec(1.2, 0.9, random.uniform(-0.6, -0.01)).asDiagonal() * random.rotation();
        Quat start(svd_rotation(f));
        const Mat moved = f + random.matrix(0.02);
        EXPECT_LT((warm_rotation(moved, start) - svd_rotation(moved)).norm(), kAngleTolerance);
    }
}

TEST(WarmRotation, of_nearly_flat_elements_equals_the_svd) {
    Random random(3);
    for (const double thickness : {1e-3, 1e-6, 1e-9, -1e-9, -1e-6}) {
        for (int i = 0; i < 200; ++i) {
            const Mat f = random.rotation().toRotationMatrix() * Vec(1, 0.8, thickness).asDiagonal();
            Quat start = Quat::Identity();
            EXPECT_LT((warm_rotation(f, start) - svd_rotation(f)).norm(), kAngleTolerance);
        }
    }
}

TEST(WarmRotation, after_half_a_turn_finds_the_turn) {
    for (const Vec& axis : {Vec(1, 0, 0), Vec(0, 1, 0), Vec(0, 0, 1), Vec(Vec(1, 2, 3).normalized())}) {
        const Mat turn = Eigen::AngleAxisd(EIGEN_PI, axis).toRotationMatrix();
        Quat start = Quat::Identity();
        EXPECT_LT((warm_rotation(turn * Vec(1.1, 1, 0.9).asDiagonal(), start) - turn).norm(),
                  kAngleTolerance);
    }
}

TEST(WarmRotation, of_a_collapsed_element_is_some_rotation) {
    for (const Mat& f : {Mat(Mat::Zero()), Mat(Vec(1, 0, 0) * Vec(0, 1, 0).transpose())}) {
        Quat start = Quat::Identity();
        const Mat r = warm_rotation(f, start);
        EXPECT_NEAR(r.determinant(), 1, 1e-12);
        EXPECT_LT((r.transpose() * r - Mat::Identity()).norm(), 1e-12);
    }
}

TEST(WarmRotation, of_a_matrix_that_is_not_finite_keeps_the_warm_start) {
    Quat start(Eigen::AngleAxisd(0.3, Vec(0, 0, 1)));
    const Quat before = start;
    Mat f = Mat::Identity();
    f(1, 2) = std::nan("");
    (void)warm_rotation(f, start);
    EXPECT_EQ(start.coeffs(), before.coeffs());
}

}  // namespace
}  // namespace knead::core
