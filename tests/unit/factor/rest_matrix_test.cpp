// SPDX-License-Identifier: Apache-2.0
#include "core/factor/rest_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "unit/factor/problem.h"

namespace knead {
namespace {

using namespace core;
using namespace test;

constexpr double kDt_s = 1e-3;
constexpr double kInertia = 1.25;
/// Sums of a few dozen doubles in another order.
constexpr double kRounding = 1e-13;

/// K by the textbook: B^T D B of each tetrahedron, with the strain in Voigt's notation and the rotation taken
/// to both sides; nothing shared with RestMatrix.
Eigen::MatrixXd textbook_matrix(const Model& model, const std::vector<Mat>* rotations) {
    const auto all = static_cast<Eigen::Index>(3 * model.mass_kg.size());
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(all, all);
    for (std::size_t e = 0; e < model.elements.size(); ++e) {
        const Element& element = model.elements[e];
        Eigen::Matrix<double, 3, 4> g;
        g.rightCols<3>() = element.rest_inverse.cast<double>().transpose();
        g.col(0) = -g.rightCols<3>().rowwise().sum();
        Eigen::Matrix<double, 6, 12> b = Eigen::Matrix<double, 6, 12>::Zero();
        for (int k = 0; k < 4; ++k) {
            b.block<6, 3>(0, 3 * k) << g(0, k), 0, 0, 0, g(1, k), 0, 0, 0, g(2, k), g(1, k), g(0, k), 0, 0,
                g(2, k), g(1, k), g(2, k), 0, g(0, k);
        }
        Eigen::Matrix<double, 6, 6> d = Eigen::Matrix<double, 6, 6>::Zero();
        d.topLeftCorner<3, 3>().setConstant(element.lambda_volume);
        d.diagonal() += (Eigen::Matrix<double, 6, 1>() << 2, 2, 2, 1, 1, 1).finished() * element.mu_volume;
        const Eigen::Matrix<double, 12, 12> k = b.transpose() * d * b;
        const Eigen::Matrix3d r = rotations == nullptr ? Eigen::Matrix3d::Identity()
                                                       : Eigen::Matrix3d((*rotations)[e].cast<double>());
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                a.block<3, 3>(3 * element.nodes[i], 3 * element.nodes[j]) +=
                    kDt_s * kDt_s * r * k.block<3, 3>(3 * i, 3 * j) * r.transpose();
    }
    for (std::size_t i = 0; i < model.mass_kg.size(); ++i)
        for (int d = 0; d < 3; ++d) {
            const auto k = static_cast<Eigen::Index>(3 * i) + d;
            a(k, k) += kInertia * model.mass_kg[i];
        }
    const auto n = static_cast<Eigen::Index>(3 * model.free_count);
    return a.topLeftCorner(n, n);
}

TEST(RestMatrix, of_a_heterogeneous_box_is_the_textbook_matrix) {
    const Model model = make_problem({});
    RestMatrix matrix(model, RestMatrix::Kind::elastic);
    matrix.set(kDt_s, kInertia);
    const Eigen::MatrixXd expected = textbook_matrix(model, nullptr);
    EXPECT_LE((dense(matrix) - expected).norm(), kRounding * expected.norm());
}

TEST(RestMatrix, with_turned_tetrahedra_is_the_turned_textbook_matrix) {
    const Model model = make_problem({});
    std::vector<Mat> rotations;
    for (std::size_t e = 0; e < model.elements.size(); ++e)
        rotations.push_back(
            Eigen::AngleAxisd(0.1 * static_cast<double>(e % 7), Eigen::Vector3d(1, 2, -1).normalized())
                .toRotationMatrix()
                .cast<Real>());
    RestMatrix matrix(model, RestMatrix::Kind::elastic);
    matrix.rotate(model, rotations.data());
    matrix.set(kDt_s, kInertia);
    const Eigen::MatrixXd expected = textbook_matrix(model, &rotations);
    EXPECT_LE((dense(matrix) - expected).norm(), kRounding * expected.norm());
}

TEST(RestMatrix, laplacian_is_what_the_diagonal_of_a_stretch_along_one_axis_says) {
    // With mu chosen so that 2 mu + lambda = 1 the scalar matrix is the plain Laplacian: u^T K u is the
    // integral of |grad u|^2, exact for a linear u.
    ProblemOptions options;
    options.hold = false;
    Model model = make_problem(options);
    TetMesh mesh = kuhn_cube(options.cells);
    RestMatrix matrix(model, RestMatrix::Kind::laplacian);
    matrix.set(kDt_s, kInertia);
    const Eigen::MatrixXd a = dense(matrix);
    // Constants: only the mass remains.
    const Eigen::VectorXd row_sums = a.rowwise().sum();
    for (Eigen::Index i = 0; i < a.rows(); ++i)
        EXPECT_NEAR(row_sums(i), kInertia * model.mass_kg[static_cast<std::size_t>(i)], kRounding * a.norm());
    // Element by element: (2 mu + lambda) V |grad u|^2 of a random u.
    const Eigen::VectorXd u = random_vector(model.free_count, 3);
    double energy = 0;
    for (const Element& element : model.elements) {
        Eigen::Vector3d differences;
        for (int k = 0; k < 3; ++k)
            differences(k) = u(element.nodes[k + 1]) - u(element.nodes[0]);
        const Eigen::Vector3d gradient = element.rest_inverse.cast<double>().transpose() * differences;
        energy += (2 * element.mu_volume + element.lambda_volume) * gradient.squaredNorm();
    }
    double mass_part = 0;
    for (std::size_t i = 0; i < model.free_count; ++i)
        mass_part +=
            kInertia * model.mass_kg[i] * u(static_cast<Eigen::Index>(i)) * u(static_cast<Eigen::Index>(i));
    const double expected = kDt_s * kDt_s * energy + mass_part;
    EXPECT_NEAR(u.dot(a * u), expected, kRounding * expected);
}

}  // namespace
}  // namespace knead
