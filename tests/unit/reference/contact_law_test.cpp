// SPDX-License-Identifier: Apache-2.0
#include "reference/contact_law.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

namespace knead::tools {
namespace {

constexpr double kSticks = std::numeric_limits<double>::infinity();
// Dense solves of a dozen unknowns with condition numbers up to about 1e3.
constexpr double kTolerance = 1e-10;

double uniform(std::mt19937_64& engine) {
    return 2.0 * static_cast<double>(engine() >> 11U) * 0x1.0p-53 - 1.0;
}

/// A well-conditioned symmetric positive definite compliance with full coupling, and offsets of both signs.
LawProblem random_problem(std::mt19937_64& engine, std::size_t nodes, double friction) {
    const auto size = 3 * static_cast<Eigen::Index>(nodes);
    Eigen::MatrixXd root(size, size);
    LawProblem problem;
    problem.offset_m.resize(size);
    for (Eigen::Index i = 0; i < size; ++i) {
        problem.offset_m[i] = uniform(engine);
        for (Eigen::Index j = 0; j < size; ++j)
            root(i, j) = uniform(engine);
    }
    problem.compliance_m_per_n = root * root.transpose() + 2 * Eigen::MatrixXd::Identity(size, size);
    problem.nodes.assign(nodes, NodeLaw{false, friction});
    return problem;
}

LawSolution solved(const LawProblem& problem) {
    return solve_law(problem, Eigen::VectorXd::Zero(problem.offset_m.size()),
                     std::vector<bool>(problem.nodes.size(), false));
}

/// The forces without friction by trying every set of touching nodes.
std::optional<Eigen::VectorXd> by_enumeration(const LawProblem& problem) {
    const std::size_t count = problem.nodes.size();
    for (unsigned set = 0; set < (1U << count); ++set) {
        Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(3 * Eigen::Index(count), 3 * Eigen::Index(count));
        Eigen::VectorXd rhs = Eigen::VectorXd::Zero(matrix.rows());
        for (std::size_t k = 0; k < count; ++k) {
            if ((set >> k & 1U) == 0) continue;
            const auto row = 3 * static_cast<Eigen::Index>(k);
            matrix.row(row) = problem.compliance_m_per_n.row(row);
            rhs[row] = -problem.offset_m[row];
        }
        const Eigen::VectorXd force = matrix.fullPivLu().solve(rhs);
        const Eigen::VectorXd moved = problem.compliance_m_per_n * force + problem.offset_m;
        bool good = true;
        for (Eigen::Index row = 0; row < rhs.size(); row += 3)
            good = good && force[row] >= -kTolerance && moved[row] >= -kTolerance;
        if (good) return force;
    }
    return std::nullopt;
}

TEST(ContactLaw, Frictionless_solution_is_the_one_found_by_trying_every_set) {
    std::mt19937_64 engine(7);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const LawProblem problem = random_problem(engine, 5, 0);
        const LawSolution solution = solved(problem);
        ASSERT_TRUE(solution.converged);
        const std::optional<Eigen::VectorXd> expected = by_enumeration(problem);
        ASSERT_TRUE(expected.has_value());
        EXPECT_LT((solution.force_n - *expected).norm(), kTolerance);
    }
}

TEST(ContactLaw, Coulomb_solution_obeys_gap_cone_and_slip_direction_at_every_node) {
    std::mt19937_64 engine(11);
    int slipping = 0;
    int sticking = 0;
    for (int repeat = 0; repeat < 200; ++repeat) {
        const LawProblem problem = random_problem(engine, 6, 0.4);
        const LawSolution solution = solved(problem);
        ASSERT_TRUE(solution.converged) << repeat << " error " << solution.error_n;
        const Eigen::VectorXd moved = problem.compliance_m_per_n * solution.force_n + problem.offset_m;
        for (std::size_t k = 0; k < problem.nodes.size(); ++k) {
            const Eigen::Vector3d force = solution.force_n.segment<3>(3 * Eigen::Index(k));
            const Eigen::Vector3d way = moved.segment<3>(3 * Eigen::Index(k));
            EXPECT_GE(force[0], -kTolerance);
            EXPECT_GE(way[0], -kTolerance);
            EXPECT_NEAR(force[0] * way[0], 0, kTolerance);
            EXPECT_LE(force.tail<2>().norm(), 0.4 * force[0] + kTolerance);
            if (!solution.touching[k]) {
                EXPECT_NEAR(force.norm(), 0, kTolerance);
            } else if (solution.slipping[k]) {
                ++slipping;
                const Eigen::Vector2d expected = -0.4 * force[0] * way.tail<2>().normalized();
                EXPECT_LT((force.tail<2>() - expected).norm(), kTolerance);
            } else {
                ++sticking;
                EXPECT_LT(way.tail<2>().norm(), kTolerance);
            }
        }
    }
    EXPECT_GT(slipping, 100);  // both branches were seen
    EXPECT_GT(sticking, 20);
}

TEST(ContactLaw, One_node_sticks_slips_or_is_free_as_worked_out_by_hand) {
    LawProblem problem;
    problem.compliance_m_per_n = Eigen::Vector3d(0.5, 0.25, 0.25).asDiagonal();
    problem.nodes = {{false, 0.5}};
    problem.offset_m = Eigen::Vector3d(-1, 0.2, 0);  // pushed in by 1: normal force 2, friction up to 1
    LawSolution solution = solved(problem);
    EXPECT_LT((solution.force_n - Eigen::Vector3d(2, -0.8, 0)).norm(), kTolerance);
    EXPECT_FALSE(solution.slipping[0]);
    problem.offset_m[1] = 3;  // would take 12 to hold
    solution = solved(problem);
    EXPECT_LT((solution.force_n - Eigen::Vector3d(2, -1, 0)).norm(), kTolerance);
    EXPECT_TRUE(solution.slipping[0]);
    problem.nodes = {{false, kSticks}};
    EXPECT_LT((solved(problem).force_n - Eigen::Vector3d(2, -12, 0)).norm(), kTolerance);
    problem.offset_m[0] = 1;
    EXPECT_EQ(solved(problem).force_n.norm(), 0);
    problem.nodes = {{true, kSticks}};  // bilateral: it is pulled
    EXPECT_LT((solved(problem).force_n - Eigen::Vector3d(-2, -12, 0)).norm(), kTolerance);
}

}  // namespace
}  // namespace knead::tools
