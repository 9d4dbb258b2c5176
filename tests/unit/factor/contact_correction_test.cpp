// SPDX-License-Identifier: Apache-2.0
#include "core/factor/contact_correction.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "unit/factor/problem.h"

namespace knead {
namespace {

using namespace core;
using namespace test;

constexpr double kDt_s = 1e-3;
constexpr std::size_t kAll = 1000000;
constexpr std::size_t kTools = 2;

// Error in the energy norm, relative: the table has float numbers whatever the factor has, and W's inverse
// enlarges their rounding by its condition number, about 1e2 here.
constexpr double kSingleError = 1e-4;
// The same after long sequences of sets, which must not add to it: a float's rounding, 6e-8, times the
// condition number of W with a unit diagonal, up to 8 there, times 5 for the sums of the factor (3.5e-7 was
// the most in 1,500 sequences and as many clean starts).
constexpr double kSequenceError = 2.5e-6;
constexpr double kFixedError = 5e-3;
constexpr double kDoubleError = 1e-5;

/// A box, its factor and the correction, with the dense inverse as the oracle.
struct Contact {
    Model model;
    RestMatrix matrix;
    SupernodalFactor factor;
    std::vector<std::uint32_t> touchable;
    ContactCorrection correction;
    ContactCorrection::Scratch scratch;
    std::vector<Mat> tool_inverses;
    Eigen::MatrixXd a, inverse;

    explicit Contact(FactorStorage storage, std::size_t column_bytes = ContactCorrection::kColumnBytes,
                     RestMatrix::Kind kind = RestMatrix::Kind::elastic)
        : model(make_problem({.cells = 4, .poissons_ratio = 0.4})),
          matrix(model, kind),
          factor(matrix.pattern(), matrix.block_size(), storage),
          touchable(every_other(model.free_count)),
          correction(factor, touchable, kTools, column_bytes),
          scratch(correction),
          tool_inverses(kTools, Mat::Zero()) {
        remake(kDt_s);
        correction.build();
    }

    void remake(double dt_s) {
        matrix.set(dt_s, 1);
        EXPECT_TRUE(factor.factorise(matrix.values()));
        a = dense(matrix);
        if (matrix.block_size() == 1) {
            const Eigen::MatrixXd scalar = a;
            a = Eigen::MatrixXd::Zero(3 * scalar.rows(), 3 * scalar.rows());
            for (Eigen::Index i = 0; i < scalar.rows(); ++i)
                for (Eigen::Index j = 0; j < scalar.rows(); ++j)
                    a.block<3, 3>(3 * i, 3 * j).diagonal().setConstant(scalar(i, j));
        }
        inverse = a.ldlt().solve(Eigen::MatrixXd::Identity(a.rows(), a.cols()));
    }

    static std::vector<std::uint32_t> every_other(std::uint32_t count) {
        std::vector<std::uint32_t> nodes;
        for (std::uint32_t i = 0; i < count; i += 2)
            nodes.push_back(count - 1 - i);
        return nodes;
    }

    [[nodiscard]] Eigen::Index size() const { return a.rows() + 3 * static_cast<Eigen::Index>(kTools); }

    /// Nodes, then tools.
    [[nodiscard]] Eigen::VectorXd apply(const Eigen::VectorXd& r) {
        std::vector<Vec> tool_rhs(kTools), tool_x(kTools);
        for (std::size_t t = 0; t < kTools; ++t)
            tool_rhs[t] = r.segment<3>(a.rows() + 3 * static_cast<Eigen::Index>(t));
        Eigen::VectorXd result(size());
        if (factor.storage() == FactorStorage::double_precision) {
            const Eigen::VectorXd rhs = r.head(a.rows());
            Eigen::VectorXd x(a.rows());
            correction.apply(rhs.data(), tool_rhs.data(), x.data(), tool_x.data(), scratch);
            result.head(a.rows()) = x;
        } else {
            const Eigen::VectorXf rhs = r.head(a.rows()).cast<float>();
            Eigen::VectorXf x(a.rows());
            correction.apply(rhs.data(), tool_rhs.data(), x.data(), tool_x.data(), scratch);
            result.head(a.rows()) = x.cast<double>();
        }
        for (std::size_t t = 0; t < kTools; ++t)
            result.segment<3>(a.rows() + 3 * static_cast<Eigen::Index>(t)) = tool_x[t];
        return result;
    }

    /// P, the inverse that knows of no held node.
    [[nodiscard]] Eigen::MatrixXd free_inverse() const {
        Eigen::MatrixXd p = Eigen::MatrixXd::Zero(size(), size());
        p.topLeftCorner(a.rows(), a.rows()) = inverse;
        for (std::size_t t = 0; t < kTools; ++t)
            p.block<3, 3>(a.rows() + 3 * static_cast<Eigen::Index>(t),
                          a.rows() + 3 * static_cast<Eigen::Index>(t)) = tool_inverses[t];
        return p;
    }

    /// Rows of the held directions: all three of held * (rotation u - t); W is inverted on their range.
    [[nodiscard]] Eigen::VectorXd exact(const std::vector<HeldNode>& held, const Eigen::VectorXd& r) const {
        Eigen::MatrixXd j = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(held.size()), size());
        for (std::size_t k = 0; k < held.size(); ++k) {
            const auto row = 3 * static_cast<Eigen::Index>(k);
            j.block<3, 3>(row, 3 * held[k].node) = held[k].held * held[k].rotation;
            j.block<3, 3>(row, a.rows() + 3 * held[k].tool) = -held[k].held;
        }
        const Eigen::MatrixXd p = free_inverse();
        const Eigen::VectorXd y = p * r;
        if (held.empty()) return y;
        const Eigen::MatrixXd w = j * p * j.transpose();
        return y - p * j.transpose() * w.completeOrthogonalDecomposition().solve(j * y);
    }

    [[nodiscard]] double error(const std::vector<HeldNode>& held, std::uint64_t seed) {
        Eigen::VectorXd r = random_vector(static_cast<std::size_t>(size()), seed);
        for (std::size_t t = 0; t < kTools; ++t)
            if (tool_inverses[t].isZero())
                r.segment<3>(a.rows() + 3 * static_cast<Eigen::Index>(t)).setZero();
        const Eigen::VectorXd expected = exact(held, r), found = apply(r);
        const Eigen::VectorXd e = (found - expected).head(a.rows()), x = expected.head(a.rows());
        const double tools = (found - expected).tail(6).norm() / (expected.tail(6).norm() + 1e-300);
        return std::max(std::sqrt(e.dot(a * e) / x.dot(a * x)), expected.tail(6).isZero() ? 0 : tools / 10);
    }
};

Mat random_rotation(std::mt19937_64& engine) {
    const Vec axis = Vec(random_number(engine), random_number(engine), random_number(engine)).normalized();
    return Eigen::AngleAxis<Real>(random_number(engine), axis).toRotationMatrix();
}

HeldNode random_hold(std::uint32_t node, std::mt19937_64& engine) {
    HeldNode held;
    held.node = node;
    held.tool = static_cast<std::uint32_t>(engine() % kTools);
    if (engine() % 2 == 0) {
        const Vec n = Vec(random_number(engine), random_number(engine), random_number(engine)).normalized();
        held.held = n * n.transpose();
    }
    held.rotation = random_rotation(engine);
    return held;
}

/// The held normal in the factor's frame, or zero.
Vec direction(const HeldNode& held) {
    return held.held.isIdentity() ? Vec::Zero()
                                  : Vec(held.rotation.transpose() * held.held.col(0).normalized());
}

/// Not one that has turned so little since `before` that the correction keeps that: it would be right to.
HeldNode another_hold(std::uint32_t node, const std::vector<HeldNode>& before, std::mt19937_64& engine) {
    HeldNode hold = random_hold(node, engine);
    for (const HeldNode& other : before) {
        while (other.node == node && std::abs(direction(hold).dot(direction(other))) > 0.9)
            hold = random_hold(node, engine);
    }
    return hold;
}

std::vector<HeldNode> random_set(const Contact& contact, std::size_t count, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::vector<HeldNode> held;
    for (std::size_t k = 0; k < count; ++k)
        held.push_back(random_hold(contact.touchable[(seed + 3 * k) % contact.touchable.size()], engine));
    return held;
}

void take_in(Contact& contact, const std::vector<HeldNode>& held) {
    ASSERT_TRUE(contact.correction.update(held.data(), held.size(), contact.tool_inverses.data(), kAll));
    ASSERT_EQ(contact.correction.taken_in(), held.size());
}

TEST(ContactCorrection, with_nothing_held_is_the_factor) {
    Contact contact(FactorStorage::single_precision);
    EXPECT_LE(contact.error({}, 1), kSingleError);
}

TEST(ContactCorrection, of_still_tools_is_the_constrained_inverse_by_columns_and_by_a_second_solve) {
    for (const auto storage :
         {FactorStorage::single_precision, FactorStorage::fixed_point_16, FactorStorage::double_precision})
        for (const std::size_t column_bytes : {std::size_t{0}, ContactCorrection::kColumnBytes}) {
            Contact contact(storage, column_bytes);
            EXPECT_EQ(contact.correction.has_columns(),
                      column_bytes > 0 && storage != FactorStorage::double_precision);
            const double allowed = storage == FactorStorage::single_precision ? kSingleError
                                   : storage == FactorStorage::fixed_point_16 ? kFixedError
                                                                              : kDoubleError;
            for (const std::size_t count : {1U, 5U, 25U}) {
                const auto held = random_set(contact, count, count);
                take_in(contact, held);
                EXPECT_LE(contact.error(held, count), allowed) << count << " held, columns " << column_bytes;
            }
        }
}

TEST(ContactCorrection, of_a_scalar_factor_is_the_constrained_inverse) {
    Contact contact(FactorStorage::single_precision, ContactCorrection::kColumnBytes,
                    RestMatrix::Kind::laplacian);
    const auto held = random_set(contact, 9, 3);
    take_in(contact, held);
    EXPECT_LE(contact.error(held, 4), kSingleError);
}

TEST(ContactCorrection, of_moving_tools_is_the_constrained_inverse_with_them) {
    Contact contact(FactorStorage::single_precision);
    contact.tool_inverses[0] = Vec(10, 20, 15).asDiagonal();
    contact.tool_inverses[0](0, 1) = contact.tool_inverses[0](1, 0) = 3;
    contact.tool_inverses[1] = 30 * Mat::Identity();
    for (const std::size_t count : {1U, 7U, 20U}) {
        const auto held = random_set(contact, count, count + 5);
        take_in(contact, held);
        EXPECT_LE(contact.error(held, count), kSingleError) << count;
    }
}

TEST(ContactCorrection, is_symmetric_and_positive) {
    Contact contact(FactorStorage::fixed_point_16);
    contact.tool_inverses[1] = 30 * Mat::Identity();
    take_in(contact, random_set(contact, 12, 2));
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        Eigen::VectorXd r = random_vector(static_cast<std::size_t>(contact.size()), 2 * seed);
        Eigen::VectorXd z = random_vector(static_cast<std::size_t>(contact.size()), 2 * seed + 1);
        const Eigen::VectorXd pr = contact.apply(r), pz = contact.apply(z);
        EXPECT_NEAR(z.dot(pr), r.dot(pz), 1e-4 * std::sqrt(r.dot(pr) * z.dot(pz)));
        EXPECT_GT(r.dot(pr), 0);
    }
}

TEST(ContactCorrection, takes_in_no_more_than_the_budget_and_lets_go_at_once) {
    Contact contact(FactorStorage::single_precision);
    const auto held = random_set(contact, 10, 1);
    const auto update = [&](const std::vector<HeldNode>& set, std::size_t most) {
        return contact.correction.update(set.data(), set.size(), contact.tool_inverses.data(), most);
    };
    EXPECT_FALSE(update(held, 4));
    EXPECT_EQ(contact.correction.taken_in(), 4U);
    EXPECT_LE(contact.error({held.begin(), held.begin() + 4}, 1), kSingleError);
    EXPECT_FALSE(update(held, 4));
    EXPECT_TRUE(update(held, 4));
    EXPECT_EQ(contact.correction.taken_in(), 10U);
    const std::vector<HeldNode> fewer(held.begin() + 2, held.end());
    EXPECT_TRUE(update(fewer, 0));
    EXPECT_EQ(contact.correction.taken_in(), 8U);
    EXPECT_LE(contact.error(fewer, 1), kSingleError);
    EXPECT_TRUE(update({}, 0));
    EXPECT_EQ(contact.correction.taken_in(), 0U);
}

TEST(ContactCorrection, keeps_a_normal_that_turned_a_little_and_renews_one_that_turned_far) {
    Contact contact(FactorStorage::single_precision);
    HeldNode held;
    held.node = contact.touchable[3];
    held.held = Vec(0, 0, 1) * Vec(0, 0, 1).transpose();
    take_in(contact, {held});
    const std::vector<HeldNode> before{held};
    const Vec little = Vec(0, 0.03, 1).normalized(), far = Vec(0, 0.5, 1).normalized();
    held.held = little * little.transpose();
    EXPECT_TRUE(contact.correction.update(&held, 1, contact.tool_inverses.data(), 0));
    EXPECT_LE(contact.error(before, 1), kSingleError);
    held.held = far * far.transpose();
    EXPECT_FALSE(contact.correction.update(&held, 1, contact.tool_inverses.data(), 0));
    EXPECT_EQ(contact.correction.taken_in(), 0U);
    take_in(contact, {held});
    EXPECT_LE(contact.error({held}, 1), kSingleError);
}

TEST(ContactCorrection, leaves_nodes_that_cannot_be_touched_to_the_caller) {
    Contact contact(FactorStorage::single_precision);
    HeldNode held;
    held.node = contact.model.free_count - 2;  // touchable are the last, the third last ...
    EXPECT_FALSE(contact.correction.takes(held.node));
    EXPECT_TRUE(contact.correction.update(&held, 1, contact.tool_inverses.data(), kAll));
    EXPECT_EQ(contact.correction.taken_in(), 0U);
}

TEST(ContactCorrection, after_a_new_factor_serves_the_old_until_the_table_is_made) {
    Contact contact(FactorStorage::single_precision);
    const auto held = random_set(contact, 6, 8);
    take_in(contact, held);
    contact.matrix.set(3 * kDt_s, 1);
    contact.factor.begin(contact.matrix.values());
    while (contact.factor.advance_staged(100000) == Progress::working)
        EXPECT_LE(contact.error(held, 2), kSingleError);
    contact.correction.begin();
    int calls = 0;
    while (contact.correction.advance(1) == Progress::working) {
        EXPECT_LE(contact.error(held, 2), kSingleError);
        ++calls;
    }
    EXPECT_GT(calls, 10);
    contact.correction.adopt();
    Contact expected(FactorStorage::single_precision);
    expected.remake(3 * kDt_s);
    contact.a = expected.a;
    contact.inverse = expected.inverse;
    EXPECT_LE(contact.error({}, 2), kSingleError);
    take_in(contact, held);
    EXPECT_LE(contact.error(held, 2), kSingleError);
}

TEST(ContactCorrection, reaction_of_a_sticking_tool_is_the_schur_complement) {
    Contact contact(FactorStorage::double_precision);
    std::vector<HeldNode> held;
    for (std::size_t k = 0; k < 6; ++k) {
        HeldNode one;
        one.node = contact.touchable[2 * k];
        held.push_back(one);
    }
    take_in(contact, held);
    // Rows of the held nodes when they move together and all others follow.
    Eigen::MatrixXd j = Eigen::MatrixXd::Zero(18, contact.a.rows()), together(18, 3);
    for (int k = 0; k < 6; ++k) {
        j.block<3, 3>(3 * k, 3 * held[static_cast<std::size_t>(k)].node).setIdentity();
        together.block<3, 3>(3 * k, 0).setIdentity();
    }
    const Eigen::MatrixXd w = j * contact.inverse * j.transpose();
    const Eigen::Matrix3d expected = together.transpose() * w.ldlt().solve(together);
    EXPECT_LE((contact.correction.reaction_kg(0) - expected).norm(), kDoubleError * expected.norm());
    EXPECT_TRUE(contact.correction.reaction_kg(1).isZero());
}

/// Iterations of conjugate gradients on `a` without the rows and columns of sticking nodes, to 1e-4 in the
/// preconditioner's norm.
template <class Apply>
int iterations(const Eigen::MatrixXd& a, const std::vector<HeldNode>& held, const Apply& apply) {
    const auto project = [&](Eigen::VectorXd v) {
        for (const HeldNode& h : held)
            v.segment<3>(3 * h.node).setZero();
        return v;
    };
    Eigen::VectorXd r = project(random_vector(static_cast<std::size_t>(a.rows()), 5));
    Eigen::VectorXd z = project(apply(r)), p = z;
    double rz = r.dot(z);
    const double enough = 1e-8 * rz;
    int count = 0;
    while (rz > enough && count < 1000) {
        const Eigen::VectorXd ap = project(a * p);
        r -= rz / p.dot(ap) * ap;
        z = project(apply(r));
        const double next = r.dot(z);
        p = z + next / rz * p;
        rz = next;
        ++count;
    }
    return count;
}

TEST(ContactCorrection, costs_no_more_iterations_than_a_factor_made_for_the_set) {
    for (const auto storage : {FactorStorage::single_precision, FactorStorage::fixed_point_16}) {
        Contact contact(storage);
        contact.remake(10 * kDt_s);
        contact.correction.build();
        std::vector<HeldNode> held(20);
        for (std::size_t k = 0; k < held.size(); ++k)
            held[k].node = contact.touchable[k];
        take_in(contact, held);
        // The true matrix: every tetrahedron turned, differently.
        std::vector<Mat> rotations;
        for (std::size_t e = 0; e < contact.model.elements.size(); ++e)
            rotations.push_back(
                Eigen::AngleAxis<Real>(0.3 * std::sin(0.1 * static_cast<double>(e)), Vec(1, 2, 2) / 3)
                    .toRotationMatrix());
        RestMatrix turned(contact.model, RestMatrix::Kind::elastic);
        turned.rotate(contact.model, rotations.data());
        turned.set(10 * kDt_s, 1);
        const Eigen::MatrixXd a = dense(turned);
        const Eigen::Index n = a.rows();
        const int corrected = iterations(a, held, [&](const Eigen::VectorXd& r) {
            Eigen::VectorXd both = Eigen::VectorXd::Zero(contact.size());
            both.head(n) = r;
            return Eigen::VectorXd(contact.apply(both).head(n));
        });
        Eigen::MatrixXd of_the_set = contact.a;
        for (const HeldNode& h : held) {
            of_the_set.middleRows<3>(3 * h.node).setZero();
            of_the_set.middleCols<3>(3 * h.node).setZero();
            of_the_set.block<3, 3>(3 * h.node, 3 * h.node).setIdentity();
        }
        const auto exact = of_the_set.ldlt();
        const int made_for_it =
            iterations(a, held, [&](const Eigen::VectorXd& r) { return Eigen::VectorXd(exact.solve(r)); });
        const auto free = contact.a.ldlt();
        const int projected =
            iterations(a, held, [&](const Eigen::VectorXd& r) { return Eigen::VectorXd(free.solve(r)); });
        EXPECT_LE(corrected, made_for_it * 1.1);
        EXPECT_GT(projected, made_for_it * 1.1) << "or the case shows nothing";
    }
}

RC_GTEST_PROP(ContactCorrectionProperty, after_any_sequence_of_sets_is_the_constrained_inverse, ()) {
    static Contact contact(FactorStorage::single_precision);
    std::mt19937_64 engine(*rc::gen::arbitrary<std::uint64_t>());
    contact.correction.clear();
    std::vector<HeldNode> held;
    const int steps = *rc::gen::inRange(1, 30);
    for (int step = 0; step < steps; ++step) {
        // Some leave, some change, some enter or come back at once, in any order.
        const std::vector<HeldNode> before = held;
        for (std::size_t k = held.size(); k-- > 0;) {
            const auto chance = engine() % 10;
            if (chance < 2) held.erase(held.begin() + static_cast<std::ptrdiff_t>(k));
            if (chance == 3) held[k] = another_hold(held[k].node, before, engine);
        }
        for (std::size_t k = engine() % 6; k-- > 0;) {
            const std::uint32_t node = contact.touchable[engine() % contact.touchable.size()];
            bool there = false;
            for (const HeldNode& other : held)
                there |= other.node == node;
            if (!there)
                held.insert(held.begin() + static_cast<std::ptrdiff_t>(engine() % (held.size() + 1)),
                            another_hold(node, before, engine));
        }
        contact.correction.update(held.data(), held.size(), contact.tool_inverses.data(), engine() % 8);
    }
    RC_ASSERT(contact.correction.update(held.data(), held.size(), contact.tool_inverses.data(), kAll));
    RC_ASSERT(contact.correction.taken_in() == held.size());
    // Sticking nodes may have been taken in with another rotation: the directions together are the same.
    RC_ASSERT(contact.error(held, engine()) <= kSequenceError);
}

}  // namespace
}  // namespace knead
