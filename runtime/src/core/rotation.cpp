// SPDX-License-Identifier: Apache-2.0
#include "core/rotation.h"

#include <cmath>

namespace knead::core {
namespace {

using Mat4 = Eigen::Matrix<Real, 4, 4>;
using Vec4 = Eigen::Matrix<Real, 4, 1>;

constexpr int kJacobiSweeps = 16;

/// q^T N q = tr(R(q)^T F) for q = (w, x, y, z).
Mat4 horn_matrix(const Mat& f) {
    Mat4 n;
    n(0, 0) = f(0, 0) + f(1, 1) + f(2, 2);
    n(0, 1) = f(2, 1) - f(1, 2);
    n(0, 2) = f(0, 2) - f(2, 0);
    n(0, 3) = f(1, 0) - f(0, 1);
    n(1, 1) = f(0, 0) - f(1, 1) - f(2, 2);
    n(1, 2) = f(0, 1) + f(1, 0);
    n(1, 3) = f(0, 2) + f(2, 0);
    n(2, 2) = f(1, 1) - f(0, 0) - f(2, 2);
    n(2, 3) = f(1, 2) + f(2, 1);
    n(3, 3) = f(2, 2) - f(0, 0) - f(1, 1);
    for (int row = 1; row < 4; ++row) {
        for (int column = 0; column < row; ++column)
            n(row, column) = n(column, row);
    }
    return n;
}

/// One Jacobi rotation that zeroes n(p, q); `vectors` collects the product.
void zero_entry(Mat4& n, Mat4& vectors, int p, int q) {
    if (n(p, q) == 0) return;
    const Real theta = (n(q, q) - n(p, p)) / (2 * n(p, q));
    const Real t = (theta < 0 ? Real(-1) : Real(1)) / (std::abs(theta) + std::sqrt(theta * theta + 1));
    const Real c = 1 / std::sqrt(t * t + 1);
    const Real s = t * c;
    for (int k = 0; k < 4; ++k) {
        const Real a = n(k, p), b = n(k, q);
        n(k, p) = c * a - s * b;
        n(k, q) = s * a + c * b;
    }
    for (int k = 0; k < 4; ++k) {
        const Real a = n(p, k), b = n(q, k);
        n(p, k) = c * a - s * b;
        n(q, k) = s * a + c * b;
    }
    for (int k = 0; k < 4; ++k) {
        const Real a = vectors(k, p), b = vectors(k, q);
        vectors(k, p) = c * a - s * b;
        vectors(k, q) = s * a + c * b;
    }
}

}  // namespace

Quat nearest_rotation(const Mat& f) noexcept {
    const Real scale = f.cwiseAbs().maxCoeff();
    if (!(scale > 0) || !std::isfinite(scale)) return Quat::Identity();
    Mat4 n = horn_matrix(f / scale);
    Mat4 vectors = Mat4::Identity();
    for (int sweep = 0; sweep < kJacobiSweeps; ++sweep) {
        for (int p = 0; p < 3; ++p) {
            for (int q = p + 1; q < 4; ++q)
                zero_entry(n, vectors, p, q);
        }
    }
    int largest = 0;
    for (int k = 1; k < 4; ++k) {
        if (n(k, k) > n(largest, largest)) largest = k;
    }
    const Vec4 v = vectors.col(largest).normalized();
    return Quat(v(0), v(1), v(2), v(3));
}

}  // namespace knead::core
