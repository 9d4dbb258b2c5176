// SPDX-License-Identifier: Apache-2.0
#include "core/sparse_inverse.h"

#include <gtest/gtest.h>

#include "unit/factor/problem.h"

namespace knead {
namespace {

using namespace core;
using namespace test;

constexpr double kDt_s = 1e-3;
/// Two products with numbers of this rounding each; condition numbers of the small matrices are below 1e3.
constexpr double kRoundingDouble = 1e-11;
constexpr double kRoundingFloat = 1e-5;

/// G by the definition: row i is the last row of blocks of the inverse Cholesky factor over i and its earlier
/// neighbours.
Eigen::MatrixXd dense_factor(const Eigen::MatrixXd& a) {
    const Eigen::Index n = a.rows() / 3;
    Eigen::MatrixXd g = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
        std::vector<Eigen::Index> nodes;
        for (Eigen::Index j = 0; j <= i; ++j)
            if (!a.block<3, 3>(3 * i, 3 * j).isZero(0)) nodes.push_back(j);
        const auto count = static_cast<Eigen::Index>(nodes.size());
        Eigen::MatrixXd small(3 * count, 3 * count);
        for (Eigen::Index p = 0; p < count; ++p)
            for (Eigen::Index q = 0; q < count; ++q)
                small.block<3, 3>(3 * p, 3 * q) = a.block<3, 3>(3 * nodes[static_cast<std::size_t>(p)],
                                                                3 * nodes[static_cast<std::size_t>(q)]);
        const Eigen::MatrixXd l = small.llt().matrixL();
        const Eigen::MatrixXd inverse = l.inverse();
        for (Eigen::Index q = 0; q < count; ++q)
            g.block<3, 3>(3 * i, 3 * nodes[static_cast<std::size_t>(q)]) =
                inverse.block<3, 3>(3 * (count - 1), 3 * q);
    }
    return g;
}

template <class S>
double error_of(const RestMatrix& matrix, const SparseInverse<S>& sparse) {
    const Eigen::MatrixXd g = dense_factor(dense(matrix));
    const std::size_t nodes = matrix.pattern().node_count;
    Eigen::VectorXd v = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * nodes));
    NodeField<S> field(nodes), out(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
        const auto at = static_cast<Eigen::Index>(3 * i);
        v.segment<3>(at) = Eigen::Vector3d(std::sin(1.0 + static_cast<double>(i)),
                                           std::cos(3.0 * static_cast<double>(i)), 1);
        field.set(i, v.segment<3>(at));
    }
    sparse.apply(field, out);
    const Eigen::VectorXd expected = g.transpose() * (g * v);
    double error = 0;
    for (std::size_t i = 0; i < nodes; ++i)
        error = std::max(error, (out.get(i) - expected.segment<3>(static_cast<Eigen::Index>(3 * i))).norm());
    return error / expected.cwiseAbs().maxCoeff();
}

TEST(SparseInverse, of_a_heterogeneous_box_is_made_of_the_cholesky_factors_around_each_node) {
    const Model model = make_problem({});
    RestMatrix matrix(model, RestMatrix::Kind::elastic);
    matrix.set(kDt_s, 1.25);
    for (const SimdTarget target : {SimdTarget::portable, best_simd_target()}) {
        SparseInverse<double> in_double(matrix.pattern(), kernels(target));
        SparseInverse<float> in_float(matrix.pattern(), kernels(target));
        in_double.make(matrix.values(), 0, in_double.row_count());
        in_float.make(matrix.values(), 0, in_float.row_count());
        EXPECT_LT(error_of(matrix, in_double), kRoundingDouble);
        EXPECT_LT(error_of(matrix, in_float), kRoundingFloat);
    }
}

TEST(SparseInverse, made_anew_row_by_row_follows_the_matrix) {
    const Model model = make_problem({});
    RestMatrix matrix(model, RestMatrix::Kind::elastic);
    SparseInverse<double> sparse(matrix.pattern(), kernels(best_simd_target()));
    matrix.set(kDt_s, 1);
    sparse.make(matrix.values(), 0, sparse.row_count());
    matrix.set(2 * kDt_s, 1.5);
    for (std::uint32_t row = 0; row < sparse.row_count(); ++row)
        sparse.make(matrix.values(), row, row + 1);
    EXPECT_LT(error_of(matrix, sparse), kRoundingDouble);
}

}  // namespace
}  // namespace knead
