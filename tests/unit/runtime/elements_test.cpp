// SPDX-License-Identifier: Apache-2.0
#include "core/elements.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <type_traits>

#include "support/random.h"
#include "support/svd_rotation.h"
#include "unit/runtime/block_asset.h"
#include "unit/runtime/element_oracles.h"

namespace knead::core {
namespace {

using test::asset_of;
using test::Random;

/// Central differences of an energy around 1 J with steps of 1e-6 m, against forces around 1e3 N.
constexpr double kDifferenceTolerance = 1e-6;
/// Sums of some hundred terms, relative to the largest result, with slivers among the tetrahedra.
template <class S>
constexpr double kRounding = std::is_same_v<S, float> ? 1e-5 : 1e-12;
/// What Newton's last step leaves (its square), and rounding; relative to how well the rotation is defined.
template <class S>
constexpr double kAngleTolerance = std::is_same_v<S, float> ? 2e-6 : 1e-12;

/// Forces of small displacements, of their largest: rounding, and what one Newton step leaves of a turn of
/// kSmallTurn (element_kernels.inl), a quarter of its square.
constexpr double kSmallForceTolerance = 3e-6;

std::vector<SimdTarget> targets() {
    std::vector<SimdTarget> result;
    for (const SimdTarget target : {SimdTarget::portable, SimdTarget::avx2, SimdTarget::avx512}) {
        if (has_simd_target(target)) result.push_back(target);
    }
    return result;
}

Model model_of(const TetMesh& mesh, std::uint64_t seed = 5) {
    Asset asset = asset_of(mesh, [](const Point&) { return false; });
    test::make_heterogeneous(asset, seed);
    return build_model(asset, {});
}

Model irregular_block(std::uint64_t seed = 5) {
    TetMesh mesh = test::kuhn_box(3, 2, 2, {0.3, 0.2, 0.2});
    test::jitter(mesh, 0.1, 0.1, seed);
    return model_of(mesh, seed);
}

/// The first tetrahedra of an irregular block. Nodes without one stay.
Model few_tetrahedra(std::size_t count) {
    TetMesh mesh = test::kuhn_box(3, 2, 2, {0.3, 0.2, 0.2});
    test::jitter(mesh, 0.1, 0.1, 5);
    mesh.tetrahedra.resize(count);
    return model_of(mesh);
}

/// Tetrahedra on nodes in general position, turned to positive volume.
Model tetrahedra_on(std::vector<Tetrahedron> tetrahedra, std::size_t nodes) {
    Random random(11);
    TetMesh mesh;
    for (std::size_t i = 0; i < nodes; ++i)
        mesh.nodes_m.push_back({random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)});
    for (Tetrahedron& t : tetrahedra) {
        Mat edges;
        for (int k = 0; k < 3; ++k) {
            for (int c = 0; c < 3; ++c)
                edges(c, k) = mesh.nodes_m[t[k + 1]][c] - mesh.nodes_m[t[0]][c];
        }
        if (edges.determinant() < 0) std::swap(t[0], t[1]);
    }
    mesh.tetrahedra = std::move(tetrahedra);
    return model_of(mesh);
}

Field random_move(const Model& model, double size_m, std::uint64_t seed) {
    Random random(seed);
    Field u(model.rest_m.size());
    for (Vec& node : u) {
        for (double& c : node)
            c = static_cast<float>(random.uniform(-size_m, size_m));  // the same in both precisions
    }
    return u;
}

template <class S>
NodeField<S> nodes_of(const Field& field) {
    NodeField<S> result(field.size());
    for (std::size_t i = 0; i < field.size(); ++i)
        result.set(i, field[i]);
    return result;
}

template <class S>
Field field_of(const NodeField<S>& nodes, std::size_t count) {
    Field result(count);
    for (std::size_t i = 0; i < count; ++i)
        result[i] = nodes.get(i);
    return result;
}

/// The element pass on plain fields, with some instruction set. S: of the state, V: of the products.
template <class S, class V = S>
class Body {
  public:
    explicit Body(const Model& model, SimdTarget target = best_simd_target())
        : nodes_(model.rest_m.size()), elements_(model, kernels(target)) {}

    Field linearise(const Field& u, double scale = 1) {
        NodeField<S> forces(nodes_);
        elements_.linearise(static_cast<S>(scale), nodes_of<S>(u), forces);
        return field_of(forces, nodes_);
    }
    Field stiffness_times(const Field& u, double scale = 1) {
        NodeField<V> out(nodes_);
        elements_.add_product(static_cast<V>(scale), nodes_of<V>(u), out);
        return field_of(out, nodes_);
    }
    Mat rotation(std::size_t element) const { return elements_.rotation(element).toRotationMatrix(); }
    Elements<S, V>& elements() { return elements_; }

  private:
    std::size_t nodes_;
    Elements<S, V> elements_;
};

double difference(const Field& a, const Field& b) {
    double result = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        result = std::max(result, (a[i] - b[i]).norm());
    return result;
}

template <class S, class V>
void expect_what_the_oracle_says(const Model& model, SimdTarget target, double move_m) {
    const Field u = random_move(model, move_m, 21), p = random_move(model, 1, 22);
    Body<S, V> body(model, target);
    const Field forces = body.linearise(u), product = body.stiffness_times(p);
    const Field expected = expected_forces(model, u), expected_kp = expected_product(model, u, p);
    // Lame's parameters are numbers of V in both.
    EXPECT_LT(difference(forces, expected), kRounding<V> * largest(expected));
    EXPECT_LT(difference(product, expected_kp), kRounding<V> * largest(expected_kp));
    for (std::size_t e = 0; e < model.elements.size(); ++e) {
        const Mat r = svd_rotation(deformation_gradient(model, model.elements[e], u));
        EXPECT_LT((body.rotation(e) - r).norm(), kAngleTolerance<V>) << "element " << e;
    }
}

void expect_what_the_oracle_says(const Model& model, double move_m) {
    for (const SimdTarget target : targets()) {
        SCOPED_TRACE(static_cast<int>(target));
        expect_what_the_oracle_says<float, float>(model, target, move_m);
        expect_what_the_oracle_says<double, float>(model, target, move_m);
        expect_what_the_oracle_says<double, double>(model, target, move_m);
    }
}

// ---- Forces

void expect_negative_energy_gradient(double move_m) {
    const Model model = irregular_block();
    Field u = random_move(model, move_m, 7);
    const Field forces = Body<double>(model).linearise(u);
    constexpr double kStep_m = 1e-6;
    for (std::size_t i = 0; i < u.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double at = u[i][c];
            u[i][c] = at + kStep_m;
            const double above = energy(model, u);
            u[i][c] = at - kStep_m;
            const double below = energy(model, u);
            u[i][c] = at;
            EXPECT_NEAR(forces[i][c], -(above - below) / (2 * kStep_m),
                        kDifferenceTolerance * largest(forces));
        }
    }
}

TEST(ElementForces, of_a_bent_body_are_the_negative_gradient_of_the_energy) {
    expect_negative_energy_gradient(0.01);
}
TEST(ElementForces, of_a_tangled_body_are_the_negative_gradient_of_the_energy) {
    expect_negative_energy_gradient(0.1);
}

TEST(ElementForces, after_a_rigid_motion_are_zero) {
    const Model model = irregular_block();
    const Mat turn = Eigen::AngleAxisd(2.5, Vec(1, -2, 0.5).normalized()).toRotationMatrix();
    Field u(model.rest_m.size());
    for (std::size_t i = 0; i < u.size(); ++i)
        u[i] = turn * model.rest_m[i] + Vec(0.3, -0.1, 0.2) - model.rest_m[i];
    const double scale = 42e3 * 0.1 * 0.1;  // stiffest modulus times an element's face
    for (const SimdTarget target : targets()) {
        EXPECT_LT(largest(Body<double>(model, target).linearise(u)), 1e-11 * scale);
        EXPECT_LT(largest(Body<float>(model, target).linearise(u)), 2e-5 * scale);
    }
}

TEST(ElementForces, after_a_turn_that_takes_one_newton_step_are_zero) {
    const Model model = irregular_block();
    const Mat turn = Eigen::AngleAxisd(1.9e-3, Vec(1, -2, 0.5).normalized()).toRotationMatrix();
    Field u(model.rest_m.size());
    for (std::size_t i = 0; i < u.size(); ++i)
        u[i] = turn * model.rest_m[i] - model.rest_m[i];
    const double scale = 42e3 * 0.1 * 0.1;
    for (const SimdTarget target : targets())
        EXPECT_LT(largest(Body<float>(model, target).linearise(u)), 1e-6 * scale);
}

template <class S, class V>
void expect_small_forces(SimdTarget target) {
    const Model model = irregular_block();
    Body<S, V> fresh(model, target), moved(model, target);
    for (const double size_m : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-20}) {
        const Field u = random_move(model, size_m, 31), expected = expected_small_forces(model, u);
        const double tolerance = kSmallForceTolerance * largest(expected);
        fresh.elements().reset();
        EXPECT_LT(difference(fresh.linearise(u), expected), tolerance) << size_m;
        (void)moved.linearise(random_move(model, 1e-3, 32));
        (void)moved.linearise(u);  // the turn that is left is a rounding of the larger one's
        EXPECT_LT(difference(moved.linearise(u), expected), tolerance) << size_m;
    }
}

TEST(ElementForces, of_small_displacements_keep_their_relative_precision) {
    for (const SimdTarget target : targets()) {
        SCOPED_TRACE(static_cast<int>(target));
        expect_small_forces<float, float>(target);
        expect_small_forces<double, float>(target);
        expect_small_forces<double, double>(target);
    }
}

TEST(ElementForces, at_rest_are_exactly_zero) {
    const Model model = irregular_block();
    const Field rest(model.rest_m.size(), Vec::Zero());
    for (const SimdTarget target : targets()) {
        Body<float> body(model, target);
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(body.linearise(rest), rest);
        EXPECT_EQ(body.rotation(0), Mat::Identity());
    }
}

TEST(ElementForces, of_an_affine_move_balance_inside) {
    Mat stretch;
    stretch << 1.1, 0.05, 0.02, 0.05, 0.93, 0.04, 0.02, 0.04, 1.2;
    const Mat turn = Eigen::AngleAxisd(0.8, Vec(0, 1, 1).normalized()).toRotationMatrix();
    TetMesh mesh = test::kuhn_cube(3);
    test::jitter(mesh, 0.1 / 3, 0.1, 3);
    const Asset asset = asset_of(mesh, [](const Point&) { return false; });  // of one material
    const Model uniform = build_model(asset, {});
    Field u(uniform.rest_m.size());
    for (std::size_t i = 0; i < u.size(); ++i)
        u[i] = turn * stretch * uniform.rest_m[i] - uniform.rest_m[i];
    const Field forces = Body<double>(uniform).linearise(u);
    int inside = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
        const Vec& p = uniform.rest_m[i];
        if (!(p.array() > 0.02).all() || !(p.array() < 0.08).all()) continue;
        EXPECT_LT(forces[i].norm(), 1e-11 * largest(forces));
        ++inside;
    }
    EXPECT_EQ(inside, 8);
}

TEST(ElementForces, sum_to_zero_with_zero_moment) {
    const Model model = irregular_block(9);
    const Field u = random_move(model, 0.03, 4);
    const Field forces = Body<double>(model).linearise(u);
    Vec force = Vec::Zero(), moment = Vec::Zero();
    for (std::size_t i = 0; i < u.size(); ++i) {
        force += forces[i];
        moment += (model.rest_m[i] + u[i]).cross(forces[i]);
    }
    EXPECT_LT(force.norm(), kRounding<double> * largest(forces));
    EXPECT_LT(moment.norm(), 1e-10 * largest(forces));
}

TEST(ElementForces, are_scaled_and_overwrite_and_the_stiffness_is_scaled_and_added) {
    const Model model = irregular_block();
    const Field u = random_move(model, 0.02, 4);
    Body<double> body(model);
    const Field forces = body.linearise(u), product = body.stiffness_times(u);
    NodeField<double> out = nodes_of<double>(product);
    body.elements().add_product(-3, nodes_of<double>(u), out);
    NodeField<double> scaled = nodes_of<double>(product);
    body.elements().linearise(-3, nodes_of<double>(u), scaled);
    for (std::size_t i = 0; i < u.size(); ++i) {
        EXPECT_LT((out.get(i) + 2 * product[i]).norm(), kRounding<double> * largest(product));
        EXPECT_LT((scaled.get(i) + 3 * forces[i]).norm(), kRounding<double> * largest(forces));
    }
}

TEST(ElementForces, bring_a_node_back_that_was_pushed_through_the_body) {
    for (const SimdTarget target : targets()) {
        TetMesh mesh = test::kuhn_box(1, 1, 1, {1, 1, 1});
        const Model model = model_of(mesh);
        Field u(model.rest_m.size(), Vec::Zero());
        u[7] = Vec(-1.2, -1.1, -1.3);  // the corner (1, 1, 1), beyond the one at the origin
        Body<float> body(model, target);
        const double step = 2e-6;  // m/N: well below two over the largest eigenvalue
        Field forces;
        for (int k = 0; k < 4000; ++k) {
            forces = body.linearise(u);
            for (std::size_t i = 0; i < u.size(); ++i)
                u[i] += step * forces[i];
        }
        for (const Element& element : model.elements)
            EXPECT_NEAR(deformation_gradient(model, element, u).determinant(), 1, 1e-2);
    }
}

// ---- Stiffness

TEST(ElementStiffness, at_rest_is_the_derivative_of_the_force) {
    const Model model = irregular_block();
    Body<double> body(model);
    (void)body.linearise(Field(model.rest_m.size(), Vec::Zero()));
    const Field u = random_move(model, 1e-6, 3);
    const Field product = body.stiffness_times(u);
    const Field forces = body.linearise(u);
    for (std::size_t i = 0; i < u.size(); ++i)
        EXPECT_LT((forces[i] + product[i]).norm(), 1e-4 * largest(product));
}

TEST(ElementStiffness, in_a_tangled_state_is_symmetric_and_positive_semidefinite) {
    const Model model = irregular_block();
    const auto n = static_cast<Eigen::Index>(model.rest_m.size());
    Body<double> body(model);
    (void)body.linearise(random_move(model, 0.08, 3));
    Eigen::MatrixXd k(3 * n, 3 * n);
    for (Eigen::Index j = 0; j < 3 * n; ++j) {
        Field u(model.rest_m.size(), Vec::Zero());
        u[static_cast<std::size_t>(j / 3)][j % 3] = 1;
        const Field column = body.stiffness_times(u);
        for (Eigen::Index i = 0; i < n; ++i)
            k.block<3, 1>(3 * i, j) = column[static_cast<std::size_t>(i)];
    }
    EXPECT_LT((k - k.transpose()).norm(), kRounding<double> * k.norm());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k, Eigen::EigenvaluesOnly);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), -kRounding<double> * k.norm());
}

// ---- Every instruction set, meshes of every kind

TEST(Elements, of_an_irregular_block_are_as_the_oracle_says) {
    expect_what_the_oracle_says(irregular_block(), 0.02);
}

class FewTetrahedra : public testing::TestWithParam<std::size_t> {};
TEST_P(FewTetrahedra, leave_lanes_empty_and_are_as_the_oracle_says) {
    expect_what_the_oracle_says(few_tetrahedra(GetParam()), 0.02);
}
INSTANTIATE_TEST_SUITE_P(Elements, FewTetrahedra, testing::Values(1, 2, 3, 17, 47, 49));

TEST(Elements, without_common_faces_are_as_the_oracle_says) {
    expect_what_the_oracle_says(tetrahedra_on({{0, 1, 2, 3}, {4, 5, 6, 7}, {3, 8, 9, 10}}, 11), 0.01);
}
TEST(Elements, that_close_a_ring_round_an_edge_are_as_the_oracle_says) {
    expect_what_the_oracle_says(tetrahedra_on({{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 4, 2}}, 5), 0.01);
}
TEST(Elements, of_a_star_that_three_cannot_share_are_as_the_oracle_says) {
    expect_what_the_oracle_says(
        tetrahedra_on({{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 3, 5}, {0, 2, 3, 6}, {1, 2, 3, 7}}, 8), 0.01);
}
TEST(Elements, that_occur_twice_are_as_the_oracle_says) {
    expect_what_the_oracle_says(tetrahedra_on({{0, 1, 2, 3}, {0, 1, 2, 3}, {1, 2, 3, 4}}, 5), 0.01);
}
TEST(Elements, that_share_a_face_three_at_a_time_are_as_the_oracle_says) {
    expect_what_the_oracle_says(tetrahedra_on({{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 2, 5}}, 6), 0.01);
}

TEST(Elements, computed_twice_give_the_same_bits) {
    const Model model = irregular_block();
    const Field u = random_move(model, 0.05, 3);
    for (const SimdTarget target : targets()) {
        Body<float> a(model, target), b(model, target);
        EXPECT_EQ(a.linearise(u), b.linearise(u));
        EXPECT_EQ(a.stiffness_times(u), b.stiffness_times(u));
    }
}

TEST(Elements, reset_forget_their_rotations) {
    const Model model = irregular_block();
    const Field u = random_move(model, 0.02, 3);
    Body<float> body(model);
    const Field first = body.linearise(u);
    (void)body.linearise(random_move(model, 0.1, 4));
    body.elements().reset();
    EXPECT_EQ(body.rotation(5), Mat::Identity());
    EXPECT_EQ(body.linearise(u), first);
}

TEST(Elements, leave_the_node_behind_the_last_and_the_fourth_numbers_zero) {
    const Model model = few_tetrahedra(17);
    const std::size_t n = model.rest_m.size();
    for (const SimdTarget target : targets()) {
        Elements<float> elements(model, kernels(target));
        NodeField<float> forces(n);
        const NodeField<float> u = nodes_of<float>(random_move(model, 0.1, 3));
        elements.linearise(1, u, forces);
        elements.add_product(1, u, forces);
        EXPECT_EQ(forces.get(n), Vec::Zero());
        for (std::size_t i = 0; i <= n; ++i)
            EXPECT_EQ(forces.data()[4 * i + 3], 0);
    }
}

// ---- Rotations of single tetrahedra

/// Tetrahedra that touch no other, and displacements that give each the deformation gradient one wants.
class LooseTetrahedra {
  public:
    explicit LooseTetrahedra(std::size_t count) : u_(4 * count, Vec::Zero()) {
        TetMesh mesh;
        for (std::uint32_t t = 0; t < count; ++t) {
            mesh.tetrahedra.push_back({4 * t, 4 * t + 1, 4 * t + 2, 4 * t + 3});
            for (const Point& p : {Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}})
                mesh.nodes_m.push_back(p);
        }
        model_ = model_of(mesh);
    }
    const Model& model() const { return model_; }
    const Field& u() const { return u_; }
    /// @return what is left of f after rounding to float
    Mat set(std::size_t t, const Mat& f) {
        for (int k = 0; k < 3; ++k)
            u_[4 * t + static_cast<std::size_t>(k) + 1] =
                (f - Mat::Identity()).col(k).cast<float>().cast<double>();
        return deformation_gradient(model_, model_.elements[t], u_);
    }

  private:
    Model model_;
    Field u_;
};

template <class S, class V>
void expect_inside_out_is_told(SimdTarget target) {
    constexpr std::size_t kCount = 37;  // fills no block of any instruction set
    Random random(5);
    LooseTetrahedra loose(kCount);
    Body<S, V> body(loose.model(), target);
    NodeField<S> forces(loose.model().rest_m.size());
    const auto told = [&] { return body.elements().linearise(1, nodes_of<S>(loose.u()), forces); };
    const auto any_turn = [&] {
        return Quat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 1).normalized();
    };
    EXPECT_FALSE(told());
    for (std::size_t t = 0; t < kCount; ++t) {
        const Mat before = any_turn() * Vec(random.uniform(0.5, 2), 1, 1).asDiagonal();
        const Mat turn = any_turn().toRotationMatrix();
        for (const double height : {-1e-3, -0.5, 1e-3, -3.0, 0.5}) {
            const Mat f = loose.set(t, turn * Vec(1.5, 0.7, height).asDiagonal() * turn.transpose());
            EXPECT_EQ(told(), f.determinant() < 0) << t << ", " << height;
        }
        EXPECT_GT(loose.set(t, before).determinant(), 0);
        EXPECT_FALSE(told());
    }
}

TEST(Elements, tell_if_one_of_many_is_inside_out) {
    for (const SimdTarget target : targets()) {
        expect_inside_out_is_told<float, float>(target);
        expect_inside_out_is_told<double, float>(target);
        expect_inside_out_is_told<double, double>(target);
    }
}

/// Several moves, each from where the last left the rotations. next(t) is the deformation gradient.
template <class S, class Next>
void expect_svd_rotations(std::size_t count, int moves, Next&& next) {
    LooseTetrahedra loose(count);
    std::vector<Body<S>> bodies;
    for (const SimdTarget target : targets())
        bodies.emplace_back(loose.model(), target);
    int checked = 0;
    for (int move = 0; move < moves; ++move) {
        std::vector<Mat> f(count);
        for (std::size_t t = 0; t < count; ++t)
            f[t] = loose.set(t, next(t));
        for (Body<S>& body : bodies) {
            (void)body.linearise(loose.u());
            for (std::size_t t = 0; t < count; ++t) {
                double gap = 0;
                const Mat expected = svd_rotation(f[t], &gap);
                if (gap < 0.05 * f[t].norm()) continue;  // two rotations are nearly as near
                EXPECT_LT((body.rotation(t) - expected).norm(), kAngleTolerance<S> * f[t].norm() / gap)
                    << f[t];
                ++checked;
            }
        }
    }
    EXPECT_GT(checked, static_cast<int>(count) * moves * static_cast<int>(bodies.size()) * 3 / 4);
}

template <class S>
class ElementRotations : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(ElementRotations, Precisions);

TYPED_TEST(ElementRotations, of_random_gradients_half_of_them_inverted_equal_the_svd) {
    Random random(1);
    expect_svd_rotations<TypeParam>(500, 6, [&](std::size_t) { return random.matrix(2); });
}

TYPED_TEST(ElementRotations, along_a_smooth_move_equal_the_svd) {
    Random random(2);
    std::vector<Mat> f(300, Mat::Identity());
    expect_svd_rotations<TypeParam>(f.size(), 40, [&](std::size_t t) {
        f[t] = Eigen::AngleAxisd(0.02, Vec(1, 2, 3).normalized()).toRotationMatrix() * f[t] +
               random.matrix(1e-3);
        return f[t];
    });
}

TYPED_TEST(ElementRotations, of_tetrahedra_pressed_flat_and_through_equal_the_svd) {
    Random random(3);
    std::vector<Mat> turns;
    for (int t = 0; t < 100; ++t)
        turns.push_back(random.rotation().toRotationMatrix());
    std::size_t call = 0;
    expect_svd_rotations<TypeParam>(turns.size(), 20, [&](std::size_t t) -> Mat {
        const double thickness = 0.5 - 0.05 * static_cast<double>(call++ / turns.size());  // .5 to -.45
        return turns[t] * Vec(1.1, 0.9, thickness).asDiagonal() * turns[t].transpose();
    });
}

TYPED_TEST(ElementRotations, of_nearly_singular_gradients_equal_the_svd) {
    Random random(4);
    expect_svd_rotations<TypeParam>(200, 5, [&](std::size_t t) -> Mat {
        const double thickness = std::array{1e-3, 1e-6, 1e-9, -1e-6}[t % 4];
        return random.rotation() * Vec(1, 0.8, thickness).asDiagonal() * random.rotation();
    });
}

TYPED_TEST(ElementRotations, after_half_a_turn_equal_the_svd) {
    Random random(5);
    double angle = 0;
    expect_svd_rotations<TypeParam>(64, 4, [&](std::size_t t) -> Mat {
        if (t == 0) angle += EIGEN_PI - 1e-4;
        const Vec axis =
            t % 2 == 0 ? Vec(Vec::Unit(static_cast<int>(t / 2 % 3))) : Vec(Vec(1, 2, 3).normalized());
        return Eigen::AngleAxisd(angle, axis).toRotationMatrix() * Vec(1.2, 1, 0.8).asDiagonal();
    });
}

TYPED_TEST(ElementRotations, of_one_mad_tetrahedron_do_not_disturb_the_other_lanes) {
    LooseTetrahedra loose(64);
    for (const SimdTarget target : targets()) {
        Body<TypeParam> body(loose.model(), target);
        const Mat f = Eigen::AngleAxisd(0.3, Vec(0, 0, 1)).toRotationMatrix();
        Mat turn;
        for (std::size_t t = 0; t < 64; ++t)
            turn = svd_rotation(loose.set(t, f));
        (void)body.linearise(loose.u());
        Field u = loose.u();
        u[4 * 9 + 2].y() = std::nan("");
        const Field forces = body.linearise(u);
        for (std::size_t t = 0; t < 64; ++t) {
            EXPECT_LT((body.rotation(t) - turn).norm(), kAngleTolerance<TypeParam> * 4) << t;
            EXPECT_EQ(forces[4 * t].allFinite(), t != 9);
        }
    }
}

TYPED_TEST(ElementRotations, stay_unit_quaternions_over_many_moves) {
    const Model model = irregular_block();
    Body<TypeParam> body(model);
    for (std::uint64_t k = 0; k < 3000; ++k)
        (void)body.linearise(random_move(model, 1e-4, k));
    for (std::size_t e = 0; e < model.elements.size(); ++e)
        EXPECT_NEAR(body.elements().rotation(e).norm(), 1, kAngleTolerance<TypeParam>);
}

}  // namespace
}  // namespace knead::core
