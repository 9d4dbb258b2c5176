// SPDX-License-Identifier: Apache-2.0
#include "core/element_pass.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "unit/runtime/block_asset.h"

namespace knead::core {
namespace {

using test::asset_of;

/// Central differences of an energy around 1 J with steps of 1e-6 m, against forces around 1e3 N.
constexpr double kDifferenceTolerance = 1e-6;
/// Sums of some hundred terms in double precision.
constexpr double kRounding = 1e-12;

Asset irregular_block(std::uint64_t seed) {
    TetMesh mesh = test::kuhn_box(3, 2, 2, {0.3, 0.2, 0.2});
    test::jitter(mesh, 0.1, 0.1, seed);
    Asset asset = asset_of(mesh, [](const Point&) { return false; });
    test::make_heterogeneous(asset, seed);
    return asset;
}

Field random_move(const Model& model, double size_m, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    Field x = model.rest_m;
    for (Vec& node : x) {
        for (double& c : node)
            c += size_m * (2 * static_cast<double>(engine() >> 11U) * 0x1.0p-53 - 1);
    }
    return x;
}

/// Oracle: the energy of the whole body from the asset, with the polar rotation from Eigen's SVD.
double energy(const Asset& asset, const Field& x) {
    double sum = 0;
    for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
        Mat rest, now;
        for (int k = 0; k < 3; ++k) {
            const auto a = asset.tetrahedra[t][0], b = asset.tetrahedra[t][k + 1];
            for (int c = 0; c < 3; ++c)
                rest(c, k) = asset.nodes_m[b][c] - asset.nodes_m[a][c];
            now.col(k) = x[b] - x[a];
        }
        const Mat f = now * rest.inverse();
        const Eigen::JacobiSVD<Mat> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
        Vec sign = Vec::Ones();
        sign.z() = svd.matrixU().determinant() * svd.matrixV().determinant();
        const Mat r = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
        const PaletteEntry& m = asset.palette[asset.palette_index[t]];
        const double mu = m.youngs_modulus_pa / 2 / (1 + m.poissons_ratio);
        const double lambda = 2 * mu * m.poissons_ratio / (1 - 2 * m.poissons_ratio);
        const double stretch = (r.transpose() * f - Mat::Identity()).trace();
        sum += rest.determinant() / 6 * (mu * (f - r).squaredNorm() + lambda / 2 * stretch * stretch);
    }
    return sum;
}

Field forces_at(const Model& model, const Field& x) {
    ElementPass pass(model);
    Field forces(x.size());
    pass.linearise(model, x, forces);
    return forces;
}

double largest(const Field& field) {
    double result = 0;
    for (const Vec& v : field)
        result = std::max(result, v.norm());
    return result;
}

void expect_negative_energy_gradient(double move_m) {
    const Asset asset = irregular_block(5);
    const Model model = build_model(asset);
    Field x = random_move(model, move_m, 7);
    const Field forces = forces_at(model, x);
    constexpr double kStep_m = 1e-6;
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double at = x[i][c];
            x[i][c] = at + kStep_m;
            const double above = energy(asset, x);
            x[i][c] = at - kStep_m;
            const double below = energy(asset, x);
            x[i][c] = at;
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
    const Model model = build_model(irregular_block(5));
    const Mat turn = Eigen::AngleAxisd(2.5, Vec(1, -2, 0.5).normalized()).toRotationMatrix();
    Field x = model.rest_m;
    for (Vec& node : x)
        node = turn * node + Vec(3, -1, 2);
    const double scale = 42e3 * 0.1 * 0.1;  // stiffest modulus times an element's face
    EXPECT_LT(largest(forces_at(model, x)), 1e-11 * scale);
}

TEST(ElementForces, of_an_affine_move_balance_inside_and_give_the_analytic_traction) {
    TetMesh mesh = test::kuhn_cube(4);
    test::jitter(mesh, 0.025, 0.1, 3);
    for (Point& p : mesh.nodes_m) {  // back on the faces: only the inside is irregular
        for (double& c : p) {
            if (c < 0.01) c = 0;
            if (c > 0.09) c = 0.1;
        }
    }
    const Asset asset = asset_of(mesh, [](const Point&) { return false; });
    const Model model = build_model(asset);
    Mat stretch;
    stretch << 1.1, 0.05, 0.02, 0.05, 0.93, 0.04, 0.02, 0.04, 1.2;
    const Mat turn = Eigen::AngleAxisd(0.8, Vec(0, 1, 1).normalized()).toRotationMatrix();
    Field x = model.rest_m;
    for (Vec& node : x)
        node = turn * stretch * node;
    const Field forces = forces_at(model, x);

    const double mu = 22e3 / 2.6, lambda = 22e3 * 0.3 / (1.3 * 0.4);
    const Mat strain = stretch - Mat::Identity();
    const Mat stress = turn * (2 * mu * strain + lambda * strain.trace() * Mat::Identity());
    Vec top = Vec::Zero();
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Vec& p = model.rest_m[i];
        const bool inside = (p.array() > 1e-6).all() && (p.array() < 0.1 - 1e-6).all();
        if (inside) {
            EXPECT_LT(forces[i].norm(), 1e-11 * largest(forces));
        }
        if (p.x() > 0.01 && p.x() < 0.09 && p.y() > 0.01 && p.y() < 0.09 && p.z() > 0.1 - 1e-9)
            top += forces[i];
    }
    // Nodes of the top face inside its edges carry the face's traction on their share of its area.
    double area = 0;
    for (const Tetrahedron& t : asset.tetrahedra) {
        std::vector<Vec> on_top;
        int counted = 0;
        for (const auto n : t) {
            const Vec& p = model.rest_m[n];
            if (p.z() < 0.1 - 1e-9) continue;
            on_top.push_back(p);
            counted += p.x() > 0.01 && p.x() < 0.09 && p.y() > 0.01 && p.y() < 0.09 ? 1 : 0;
        }
        if (on_top.size() == 3)
            area += (on_top[1] - on_top[0]).cross(on_top[2] - on_top[0]).norm() / 2 * counted / 3;
    }
    EXPECT_LT((top + stress.col(2) * area).norm(), 1e-11 * top.norm());
}

TEST(ElementForces, sum_to_zero_with_zero_moment) {
    const Model model = build_model(irregular_block(9));
    const Field x = random_move(model, 0.03, 4);
    const Field forces = forces_at(model, x);
    Vec force = Vec::Zero(), moment = Vec::Zero();
    for (std::size_t i = 0; i < x.size(); ++i) {
        force += forces[i];
        moment += x[i].cross(forces[i]);
    }
    EXPECT_LT(force.norm(), kRounding * largest(forces));
    EXPECT_LT(moment.norm(), 1e-10 * largest(forces));
}

/// Column by column: dense K(R) from apply_stiffness().
Eigen::MatrixXd dense_stiffness(const Model& model, const ElementPass& pass) {
    const std::size_t n = model.rest_m.size();
    Eigen::MatrixXd k(3 * n, 3 * n);
    Field u(n, Vec::Zero()), out(n);
    for (std::size_t j = 0; j < 3 * n; ++j) {
        u[j / 3][static_cast<int>(j % 3)] = 1;
        pass.apply_stiffness(model, u, out);
        u[j / 3].setZero();
        for (std::size_t i = 0; i < n; ++i)
            k.block<3, 1>(3 * i, j) = out[i];
    }
    return k;
}

TEST(ElementStiffness, at_rest_is_the_derivative_of_the_force) {
    const Model model = build_model(irregular_block(5));
    ElementPass pass(model);
    Field forces(model.rest_m.size()), product(model.rest_m.size());
    pass.linearise(model, model.rest_m, forces);
    const Field moved = random_move(model, 1e-6, 3);
    Field u(moved.size());
    for (std::size_t i = 0; i < u.size(); ++i)
        u[i] = moved[i] - model.rest_m[i];
    pass.apply_stiffness(model, u, product);
    const Field after = forces_at(model, moved);
    for (std::size_t i = 0; i < u.size(); ++i)
        EXPECT_LT((after[i] + product[i]).norm(), 1e-4 * largest(product));
}

TEST(ElementStiffness,
     in_a_tangled_state_is_symmetric_and_positive_semidefinite_and_has_its_diagonal_blocks) {
    const Model model = build_model(irregular_block(5));
    ElementPass pass(model);
    Field forces(model.rest_m.size());
    pass.linearise(model, random_move(model, 0.08, 3), forces);
    const Eigen::MatrixXd k = dense_stiffness(model, pass);
    EXPECT_LT((k - k.transpose()).norm(), kRounding * k.norm());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k, Eigen::EigenvaluesOnly);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), -kRounding * k.norm());
    std::vector<Mat> blocks(model.rest_m.size());
    pass.diagonal_blocks(model, blocks);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        EXPECT_LT((k.block<3, 3>(3 * i, 3 * i) - blocks[i]).norm(), kRounding * k.norm());
    }
}

TEST(ElementStiffness, reduced_to_a_tool_is_the_triple_product) {
    const Model model = build_model(irregular_block(5));
    ElementPass pass(model);
    const std::size_t n = model.rest_m.size();
    Field forces(n);
    pass.linearise(model, random_move(model, 0.03, 3), forces);
    std::vector<Mat> columns(n, Mat::Zero());
    std::vector<std::uint8_t> marked(n, 0);
    Eigen::MatrixXd e = Eigen::MatrixXd::Zero(3 * n, 3);
    const Vec normal = Vec(1, 2, -1).normalized();
    for (const std::size_t i : {0, 3, 4, 11}) {
        columns[i] = i == 4 ? Mat(normal * normal.transpose()) : Mat(Mat::Identity());
        marked[i] = 1;
        e.block<3, 3>(3 * i, 0) = columns[i];
    }
    const Mat expected = e.transpose() * dense_stiffness(model, pass) * e;
    EXPECT_LT((pass.reduced_stiffness(model, columns, marked) - expected).norm(),
              kRounding * expected.norm());
}

}  // namespace
}  // namespace knead::core
