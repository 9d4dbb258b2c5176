// SPDX-License-Identifier: Apache-2.0
#include "core/factor/supernodal_factor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "unit/factor/problem.h"

namespace knead {
namespace {

using namespace core;
using namespace test;

constexpr double kDt_s = 1e-3;

// Error of a solve in the energy norm, relative. The numbers of the factor are rounded once; the rest are
// sums. Half as many digits are lost as the condition number has (here about 1e3).
constexpr double kDoubleError = 1e-12;
constexpr double kSingleError = 2e-5;
constexpr double kFixedError = 2e-3;

double allowed(FactorStorage storage) {
    switch (storage) {
        case FactorStorage::double_precision:
            return kDoubleError;
        case FactorStorage::fixed_point_16:
            return kFixedError;
        case FactorStorage::single_precision:
            break;
    }
    return kSingleError;
}

struct Case {
    SimdTarget target;
    RestMatrix::Kind kind;
    FactorStorage storage;
};

std::vector<Case> cases() {
    std::vector<Case> result;
    for (const SimdTarget target : simd_targets())
        for (const auto kind : {RestMatrix::Kind::elastic, RestMatrix::Kind::laplacian})
            for (const auto storage : {FactorStorage::single_precision, FactorStorage::fixed_point_16,
                                       FactorStorage::double_precision})
                result.push_back({target, kind, storage});
    return result;
}

std::string name_of(const testing::TestParamInfo<Case>& info) {
    static const char* const kTargets[] = {"portable", "avx2", "avx512"};
    static const char* const kKinds[] = {"elastic", "laplacian"};
    static const char* const kStorages[] = {"single", "fixed", "double"};
    return std::string(kTargets[static_cast<int>(info.param.target)]) + "_" +
           kKinds[static_cast<int>(info.param.kind)] + "_" + kStorages[static_cast<int>(info.param.storage)];
}

/// A matrix, its factor, and solves in the number type of the factor.
struct Solver {
    RestMatrix matrix;
    SupernodalFactor factor;
    SupernodalFactor::Scratch scratch;

    Solver(const Model& model, const Case& c, double dt_s = kDt_s)
        : matrix(model, c.kind),
          factor(matrix.pattern(), matrix.block_size(), c.storage, c.target),
          scratch(factor) {
        matrix.set(dt_s, 1);
    }

    Eigen::VectorXd solve(const Eigen::VectorXd& rhs) { return run(rhs, false); }
    Eigen::VectorXd solve_three(const Eigen::VectorXd& rhs) { return run(rhs, true); }

  private:
    template <class S>
    Eigen::VectorXd run_as(const Eigen::VectorXd& rhs, bool three) {
        Eigen::Matrix<S, Eigen::Dynamic, 1> x = rhs.cast<S>();
        if (three)
            factor.solve_three(x.data(), x.data(), scratch);
        else
            factor.solve(x.data(), x.data(), scratch);
        return x.template cast<double>();
    }
    Eigen::VectorXd run(const Eigen::VectorXd& rhs, bool three) {
        return factor.storage() == FactorStorage::double_precision ? run_as<double>(rhs, three)
                                                                   : run_as<float>(rhs, three);
    }
};

/// The matrix as it acts on three numbers of each node.
Eigen::MatrixXd dense_three(const RestMatrix& matrix) {
    const Eigen::MatrixXd a = dense(matrix);
    if (matrix.block_size() == 3) return a;
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * a.rows(), 3 * a.cols());
    for (Eigen::Index i = 0; i < a.rows(); ++i)
        for (Eigen::Index j = 0; j < a.cols(); ++j)
            result.block<3, 3>(3 * i, 3 * j) = a(i, j) * Eigen::Matrix3d::Identity();
    return result;
}

double energy_error(const Eigen::MatrixXd& a, const Eigen::VectorXd& x, const Eigen::VectorXd& exact) {
    const Eigen::VectorXd e = x - exact;
    return std::sqrt(e.dot(a * e) / exact.dot(a * exact));
}

class SupernodalFactorCase : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(All, SupernodalFactorCase, testing::ValuesIn(cases()), name_of);

TEST_P(SupernodalFactorCase, of_boxes_of_all_sizes_solves_as_a_dense_factor) {
    for (const std::uint32_t cells : {2U, 3U, 5U, 7U})
        for (const bool hold : {true, false}) {
            if (!hold && cells > 5) continue;  // dense: too slow
            ProblemOptions options;
            options.cells = cells;
            options.hold = hold;
            const Model model = make_problem(options);
            Solver solver(model, GetParam());
            ASSERT_TRUE(solver.factor.factorise(solver.matrix.values()));
            const Eigen::MatrixXd a = dense_three(solver.matrix);
            const Eigen::VectorXd rhs = random_vector(static_cast<std::size_t>(a.rows()), cells);
            const Eigen::VectorXd exact = a.ldlt().solve(rhs);
            EXPECT_LE(energy_error(a, solver.solve(rhs), exact), allowed(solver.factor.storage()))
                << cells << " cells, held " << hold;
        }
}

TEST_P(SupernodalFactorCase, is_symmetric_up_to_the_rounding_of_the_sums) {
    ProblemOptions options;
    options.cells = 5;
    Solver solver(make_problem(options), GetParam());
    ASSERT_TRUE(solver.factor.factorise(solver.matrix.values()));
    // Whatever the storage: fixed point is symmetric too. Float sums of some thousand terms.
    const double tolerance = solver.factor.storage() == FactorStorage::double_precision ? 1e-13 : 1e-5;
    const std::size_t size = std::size_t{3} * solver.factor.node_count();
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        const Eigen::VectorXd r = random_vector(size, 2 * seed), z = random_vector(size, 2 * seed + 1);
        const Eigen::VectorXd pr = solver.solve(r), pz = solver.solve(z);
        EXPECT_NEAR(z.dot(pr), r.dot(pz), tolerance * std::sqrt(r.dot(pr) * z.dot(pz)));
        EXPECT_GT(r.dot(pr), 0);
    }
}

TEST_P(SupernodalFactorCase, three_vectors_at_once_are_three_solves) {
    if (GetParam().kind == RestMatrix::Kind::laplacian) return;  // solves three at once anyway
    Solver solver(make_problem({}), GetParam());
    ASSERT_TRUE(solver.factor.factorise(solver.matrix.values()));
    const std::size_t size = std::size_t{3} * solver.factor.node_count();
    const Eigen::VectorXd rhs = random_vector(3 * size, 4);
    const Eigen::VectorXd x = solver.solve_three(rhs);
    const double tolerance = solver.factor.storage() == FactorStorage::double_precision ? 1e-13 : 1e-5;
    for (int k = 0; k < 3; ++k) {
        const auto part = static_cast<Eigen::Index>(k * size);
        const Eigen::VectorXd one = solver.solve(rhs.segment(part, static_cast<Eigen::Index>(size)));
        EXPECT_LE((x.segment(part, static_cast<Eigen::Index>(size)) - one).norm(), tolerance * one.norm());
    }
}

TEST_P(SupernodalFactorCase, made_in_slices_of_any_size_is_the_same_bit_for_bit) {
    ProblemOptions options;
    options.cells = 5;
    const Model model = make_problem(options);
    Solver whole(model, GetParam());
    ASSERT_TRUE(whole.factor.factorise(whole.matrix.values()));
    const Eigen::VectorXd rhs = random_vector(std::size_t{3} * whole.factor.node_count(), 4);
    const Eigen::VectorXd expected = whole.solve(rhs);
    for (const std::uint64_t work : {1ULL, 1000ULL, 77777ULL, 1000000ULL}) {
        Solver sliced(model, GetParam());
        // Something else before, half done: none of it must remain.
        sliced.matrix.set(10 * kDt_s, 2);
        ASSERT_TRUE(sliced.factor.factorise(sliced.matrix.values()));
        sliced.factor.begin(sliced.matrix.values());
        sliced.factor.advance(1000000);
        sliced.matrix.set(kDt_s, 1);
        sliced.factor.begin(sliced.matrix.values());
        const Eigen::VectorXd before = sliced.solve(rhs);
        int calls = 1;
        Progress progress = Progress::working;
        while ((progress = sliced.factor.advance(work)) == Progress::working) {
            if (++calls % 100 == 0) {
                ASSERT_EQ(sliced.solve(rhs), before) << "the old factor serves until the end";
            }
        }
        ASSERT_EQ(progress, Progress::done);
        EXPECT_EQ(sliced.solve(rhs), expected);
        if (work < 100000) {
            EXPECT_GT(calls, 10);
        }
    }
}

TEST_P(SupernodalFactorCase, of_an_indefinite_or_not_finite_matrix_is_refused_and_the_old_one_kept) {
    Solver solver(make_problem({}), GetParam());
    EXPECT_FALSE(solver.factor.ready());
    ASSERT_TRUE(solver.factor.factorise(solver.matrix.values()));
    EXPECT_TRUE(solver.factor.ready());
    const Eigen::VectorXd rhs = random_vector(std::size_t{3} * solver.factor.node_count(), 4);
    const Eigen::VectorXd expected = solver.solve(rhs);
    const auto& pattern = solver.matrix.pattern();
    const std::size_t block = GetParam().kind == RestMatrix::Kind::elastic ? 9 : 1;
    const std::size_t count = pattern.row_nodes.size() * block;
    const std::size_t middle = pattern.column_begin[pattern.node_count / 2] * block;
    for (const double bad :
         {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        std::vector<double> values(solver.matrix.values(), solver.matrix.values() + count);
        values[middle] = bad;  // on the diagonal
        EXPECT_FALSE(solver.factor.factorise(values.data())) << bad;
        EXPECT_TRUE(solver.factor.ready());
        EXPECT_EQ(solver.solve(rhs), expected);
        values[middle] = solver.matrix.values()[middle];
        if (std::isfinite(bad)) continue;
        values[middle + block] = bad;  // off the diagonal
        EXPECT_FALSE(solver.factor.factorise(values.data())) << bad;
        EXPECT_EQ(solver.solve(rhs), expected);
    }
}

TEST_P(SupernodalFactorCase, piece_of_work_is_never_larger_than_said) {
    ProblemOptions options;
    options.cells = 7;
    Solver solver(make_problem(options), GetParam());
    // The whole is about n^2 operations here; no piece may be a great part of it.
    solver.factor.begin(solver.matrix.values());
    std::uint64_t calls = 0;
    const std::uint64_t slice = solver.factor.largest_piece();
    while (solver.factor.advance(slice) == Progress::working)
        ++calls;
    EXPECT_GT(calls, 5U);
}

TEST(SupernodalFactor, of_all_instruction_sets_agrees_to_rounding) {
    ProblemOptions options;
    options.cells = 5;
    const Model model = make_problem(options);
    for (const auto kind : {RestMatrix::Kind::elastic, RestMatrix::Kind::laplacian}) {
        Solver reference(model, {SimdTarget::portable, kind, FactorStorage::single_precision});
        ASSERT_TRUE(reference.factor.factorise(reference.matrix.values()));
        const Eigen::VectorXd rhs = random_vector(std::size_t{3} * reference.factor.node_count(), 4);
        const Eigen::VectorXd expected = reference.solve(rhs);
        const Eigen::MatrixXd a = dense_three(reference.matrix);
        for (const SimdTarget target : simd_targets()) {
            Solver solver(model, {target, kind, FactorStorage::single_precision});
            ASSERT_TRUE(solver.factor.factorise(solver.matrix.values()));
            EXPECT_LE(energy_error(a, solver.solve(rhs), expected), kSingleError);
        }
    }
}

TEST(SupernodalFactor, of_a_contrast_of_a_million_in_fixed_point_does_not_overflow) {
    ProblemOptions options;
    options.cells = 5;
    options.contrast = 1e6;
    options.poissons_ratio = 0.49;
    const Model model = make_problem(options);
    Solver solver(model, {best_simd_target(), RestMatrix::Kind::elastic, FactorStorage::fixed_point_16},
                  10e-3);
    ASSERT_TRUE(solver.factor.factorise(solver.matrix.values()));
    const Eigen::VectorXd x = solver.solve(random_vector(std::size_t{3} * solver.factor.node_count(), 4));
    EXPECT_TRUE(x.allFinite());
    EXPECT_GT(x.norm(), 0);
}

TEST(SupernodalFactor, of_a_matrix_in_parts_and_of_single_nodes_solves_each) {
    // Three nodes: two joined, one alone; lower triangle in columns.
    MatrixPattern pattern;
    pattern.node_count = 3;
    pattern.column_begin = {0, 2, 3, 4};
    pattern.row_nodes = {0, 2, 1, 2};
    const double values[] = {4, 1, 9, 3};
    for (const SimdTarget target : simd_targets()) {
        SupernodalFactor factor(pattern, 1, FactorStorage::double_precision, target);
        SupernodalFactor::Scratch scratch(factor);
        ASSERT_TRUE(factor.factorise(values));
        double x[9] = {1, 2, 3, 9, 18, 27, 5, 6, 7};
        factor.solve(x, x, scratch);
        const double determinant = 4 * 3 - 1;
        for (int d = 0; d < 3; ++d) {
            const double a = 1 + d, b = 5 + d;
            EXPECT_NEAR(x[d], (3 * a - b) / determinant, 1e-15);
            EXPECT_NEAR(x[3 + d], 1 + d, 1e-15);
            EXPECT_NEAR(x[6 + d], (4 * b - a) / determinant, 2e-15);
        }
    }
}

}  // namespace
}  // namespace knead
