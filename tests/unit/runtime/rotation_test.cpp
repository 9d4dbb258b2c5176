// SPDX-License-Identifier: Apache-2.0
#include "core/rotation.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/svd_rotation.h"

namespace knead::core {
namespace {

using test::Random;
using test::svd_rotation;

/// The eigenvectors are good to 1e-14 over the gap of the eigenvalues, which is above 1e-3 below.
constexpr double kAngleTolerance = 1e-10;

Mat nearest(const Mat& f) {
    return nearest_rotation(f).toRotationMatrix();
}

TEST(NearestRotation, of_random_matrices_equals_the_svd) {
    Random random(1);
    int checked = 0;
    for (int i = 0; i < 20000; ++i) {
        const Mat f = random.matrix(2);  // half of them inverted
        double gap = 0;
        const Mat expected = svd_rotation(f, &gap);
        if (gap < 1e-3) continue;  // two rotations equally near: not defined
        EXPECT_LT((nearest(f) - expected).norm(), kAngleTolerance) << f;
        ++checked;
    }
    EXPECT_GT(checked, 19000);
}

TEST(NearestRotation, of_nearly_flat_elements_equals_the_svd) {
    Random random(3);
    for (const double thickness : {1e-3, 1e-6, 1e-9, -1e-9, -1e-6}) {
        for (int i = 0; i < 200; ++i) {
            const Mat f = random.rotation().toRotationMatrix() * Vec(1, 0.8, thickness).asDiagonal();
            EXPECT_LT((nearest(f) - svd_rotation(f)).norm(), kAngleTolerance);
        }
    }
}

TEST(NearestRotation, of_half_a_turn_is_the_turn) {
    for (const Vec& axis : {Vec(1, 0, 0), Vec(0, 1, 0), Vec(0, 0, 1), Vec(Vec(1, 2, 3).normalized())}) {
        const Mat turn = Eigen::AngleAxisd(EIGEN_PI, axis).toRotationMatrix();
        EXPECT_LT((nearest(turn * Vec(1.1, 1, 0.9).asDiagonal()) - turn).norm(), kAngleTolerance);
    }
}

TEST(NearestRotation, of_a_collapsed_element_is_some_rotation) {
    for (const Mat& f : {Mat(Mat::Zero()), Mat(Vec(1, 0, 0) * Vec(0, 1, 0).transpose())}) {
        const Mat r = nearest(f);
        EXPECT_NEAR(r.determinant(), 1, 1e-12);
        EXPECT_LT((r.transpose() * r - Mat::Identity()).norm(), 1e-12);
    }
}

}  // namespace
}  // namespace knead::core
