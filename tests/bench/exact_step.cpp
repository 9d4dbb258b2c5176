// SPDX-License-Identifier: Apache-2.0
#include "bench/exact_step.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>

namespace knead::bench {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using Factor = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>>;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kNoUnknown = -1;
/// Above this many unknowns a factor takes minutes with plain C++ (n = 20); block Jacobi converges there.
constexpr Eigen::Index kLargestFactor = 12000;
/// A factor of an earlier step that needs more iterations than this is replaced.
constexpr int kStaleIterations = 16;
constexpr int kLargestIterations = 5000;
/// Reduction of the preconditioned residual asked of one solve, and of the correction asked of them all.
constexpr double kReduction = 1e-13;
constexpr double kCorrection = 1e-13;
constexpr int kLargestCorrections = 6;

/// The rotation nearest to F.
Matrix3d nearest_rotation(const Matrix3d& f) {
    const Eigen::JacobiSVD<Matrix3d> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vector3d sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
    return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

/// Derivative of the stress at rotation R along dF, R kept.
Matrix3d stress_change(const Body::Element& e, const Matrix3d& r, const Matrix3d& df) {
    const Matrix3d local = r.transpose() * df;
    return r * (e.mu_pa * (local + local.transpose()) + e.lambda_pa * local.trace() * Matrix3d::Identity());
}

}  // namespace

struct ExactStep::Impl {
    const Body& body;
    std::vector<int> unknown;                    // [nodes] first unknown of the node, or kNoUnknown
    SparseMatrix matrix;                         // lower triangle of A
    std::vector<std::array<int, 144>> position;  // [elements] where entry (row, column) of its 12 x 12 goes
    std::vector<Matrix3d> rotations;             // [elements] of this step
    Factor factor;
    std::vector<Matrix3d> diagonal_inverse;  // [active]
    double factor_dt_s = 0;                  // 0: no factor yet
    int iterations = 0;                      // of this step

    explicit Impl(const Body& b);
    void make_pattern();
    void assemble(const Columns& predicted, double dt_s, VectorXd& rhs);
    void add_element(std::size_t index, const Columns& predicted, double dt_s, VectorXd& rhs);
    void add_nodes(double dt_s, VectorXd& rhs, const State& from);
    void factorise(double dt_s);
    [[nodiscard]] VectorXd precondition(const VectorXd& r) const;
    [[nodiscard]] bool conjugate_gradients(const VectorXd& rhs, int limit, VectorXd& x);
    [[nodiscard]] VectorXd solve(const VectorXd& rhs, double dt_s);
    [[nodiscard]] Vector3d force(const State& from, const Columns& predicted, const State& to,
                                 double dt_s) const;
    [[nodiscard]] bool direct() const { return matrix.rows() <= kLargestFactor; }
};

ExactStep::Impl::Impl(const Body& b)
    : body(b), unknown(static_cast<std::size_t>(b.rest_m.cols()), kNoUnknown), rotations(b.elements.size()) {
    int next = 0;
    for (const std::uint32_t node : body.active) {
        unknown[node] = next;
        next += 3;
    }
    make_pattern();
    if (direct()) factor.analyzePattern(matrix);
}

void ExactStep::Impl::make_pattern() {
    const auto size = static_cast<Eigen::Index>(3 * body.active.size());
    std::vector<Eigen::Triplet<double, int>> entries;
    const auto each_entry = [&](const Body::Element& e, const auto& use) {
        for (std::size_t k = 0; k < 144; ++k) {
            const int row_node = unknown[e.nodes[k / 12 / 3]];
            const int column_node = unknown[e.nodes[k % 12 / 3]];
            const int row = row_node + static_cast<int>(k / 12 % 3);
            const int column = column_node + static_cast<int>(k % 12 % 3);
            if (row_node != kNoUnknown && column_node != kNoUnknown && row >= column) use(k, row, column);
        }
    };
    for (const Body::Element& e : body.elements)
        each_entry(e, [&](std::size_t, int row, int column) { entries.emplace_back(row, column, 0.0); });
    matrix.resize(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    position.resize(body.elements.size());
    for (std::size_t t = 0; t < position.size(); ++t) {
        position[t].fill(kNoUnknown);
        each_entry(body.elements[t], [&](std::size_t k, int row, int column) {
            const int* const first = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
            const int* const last = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
            position[t][k] = static_cast<int>(std::lower_bound(first, last, row) - matrix.innerIndexPtr());
        });
    }
}

void ExactStep::Impl::add_element(std::size_t index, const Columns& predicted, double dt_s, VectorXd& rhs) {
    const Body::Element& e = body.elements[index];
    const Matrix3d f = body.deformation_gradient(e, predicted);
    const Matrix3d r = rotations[index] = nearest_rotation(f);
    const Matrix3d stress =
        2 * e.mu_pa * (f - r) + e.lambda_pa * ((r.transpose() * f).trace() - 3) * r;  // first Piola-Kirchhoff
    const double scale = dt_s * dt_s * e.volume_m3;
    double* const values = matrix.valuePtr();
    for (std::size_t b = 0; b < 4; ++b) {
        const Vector3d gradient = e.shape_gradients.col(static_cast<Eigen::Index>(b));
        if (unknown[e.nodes[b]] == kNoUnknown) continue;
        rhs.segment<3>(unknown[e.nodes[b]]) -= scale * (stress * gradient);
        for (std::size_t j = 0; j < 3; ++j) {
            const Vector3d axis = Vector3d::Unit(static_cast<Eigen::Index>(j));
            const Eigen::Matrix<double, 3, 4> columns =
                scale * stress_change(e, r, axis * gradient.transpose()) * e.shape_gradients;
            for (std::size_t row = 0; row < 12; ++row)
                if (const int at = position[index][12 * row + 3 * b + j]; at != kNoUnknown)
                    values[at] +=
                        columns(static_cast<Eigen::Index>(row % 3), static_cast<Eigen::Index>(row / 3));
        }
    }
}

void ExactStep::Impl::add_nodes(double dt_s, VectorXd& rhs, const State& from) {
    const double c = body.damping_per_s;
    for (const std::uint32_t node : body.active) {
        const double m = body.mass_kg[node];
        rhs.segment<3>(unknown[node]) +=
            dt_s * dt_s * m * (body.gravity_m_per_s2 - c * from.velocities_m_per_s.col(node));
        for (int k = 0; k < 3; ++k)
            matrix.coeffRef(unknown[node] + k, unknown[node] + k) += m * (1 + c * dt_s);
    }
}

void ExactStep::Impl::assemble(const Columns& predicted, double dt_s, VectorXd& rhs) {
    std::fill_n(matrix.valuePtr(), matrix.nonZeros(), 0.0);
    for (std::size_t t = 0; t < body.elements.size(); ++t)
        add_element(t, predicted, dt_s, rhs);
}

void ExactStep::Impl::factorise(double dt_s) {
    factor_dt_s = dt_s;
    if (direct()) {
        factor.factorize(matrix);
        return;
    }
    diagonal_inverse.resize(body.active.size());
    for (std::size_t i = 0; i < diagonal_inverse.size(); ++i) {
        Matrix3d block;
        for (int k = 0; k < 9; ++k) {
            const int first = static_cast<int>(3 * i);
            block(k / 3, k % 3) =
                matrix.coeff(first + std::max(k / 3, k % 3), first + std::min(k / 3, k % 3));
        }
        diagonal_inverse[i] = block.inverse();
    }
}

VectorXd ExactStep::Impl::precondition(const VectorXd& r) const {
    if (direct()) return factor.solve(r);
    VectorXd z(r.size());
    for (std::size_t i = 0; i < diagonal_inverse.size(); ++i) {
        const auto first = static_cast<Eigen::Index>(3 * i);
        z.segment<3>(first) = diagonal_inverse[i] * r.segment<3>(first);
    }
    return z;
}

/// @return false when `limit` iterations were not enough
bool ExactStep::Impl::conjugate_gradients(const VectorXd& rhs, int limit, VectorXd& x) {
    x = VectorXd::Zero(rhs.size());
    VectorXd r = rhs;
    VectorXd z = precondition(r);
    VectorXd direction = z;
    double rz = r.dot(z);
    const double target = kReduction * kReduction * rz;
    for (int k = 0; rz > target; ++k) {
        if (k == limit) return false;
        ++iterations;
        const VectorXd product = matrix.selfadjointView<Eigen::Lower>() * direction;
        const double alpha = rz / direction.dot(product);
        x += alpha * direction;
        r -= alpha * product;
        z = precondition(r);
        const double next = r.dot(z);
        direction = z + (next / rz) * direction;
        rz = next;
    }
    return true;
}

VectorXd ExactStep::Impl::solve(const VectorXd& rhs, double dt_s) {
    const int limit = direct() ? kStaleIterations : kLargestIterations;
    if (dt_s != factor_dt_s || !direct()) factorise(dt_s);
    VectorXd x = VectorXd::Zero(rhs.size());
    VectorXd correction;
    for (int k = 0; k < kLargestCorrections; ++k) {
        const VectorXd r = rhs - matrix.selfadjointView<Eigen::Lower>() * x;
        if (!conjugate_gradients(r, limit, correction)) {
            factorise(dt_s);
            // With the factor of this very matrix what is left after a few iterations is rounding.
            (void)conjugate_gradients(r, limit, correction);
        }
        x += correction;
        if (correction.norm() <= kCorrection * x.norm()) break;
    }
    return x;
}

Vector3d ExactStep::Impl::force(const State& from, const Columns& predicted, const State& to,
                                double dt_s) const {
    std::vector<bool> on_plate(unknown.size(), false);
    Vector3d force = Vector3d::Zero();
    for (const std::uint32_t node : body.plate) {
        on_plate[node] = true;
        const Vector3d v = to.velocities_m_per_s.col(node);
        force -= body.mass_kg[node] * ((v - from.velocities_m_per_s.col(node)) / dt_s +
                                       body.damping_per_s * v - body.gravity_m_per_s2);
    }
    for (std::size_t t = 0; t < body.elements.size(); ++t) {
        const Body::Element& e = body.elements[t];
        Vector3d gradient = Vector3d::Zero();
        for (std::size_t a = 0; a < 4; ++a)
            if (on_plate[e.nodes[a]]) gradient += e.shape_gradients.col(static_cast<Eigen::Index>(a));
        if (gradient.isZero(0)) continue;
        const Matrix3d& r = rotations[t];
        const Matrix3d f = body.deformation_gradient(e, predicted);
        const Matrix3d df = body.deformation_gradient(e, to.positions_m) - f;
        const Matrix3d stress = 2 * e.mu_pa * (f - r) + e.lambda_pa * ((r.transpose() * f).trace() - 3) * r;
        force -= e.volume_m3 * ((stress + stress_change(e, r, df)) * gradient);
    }
    return force;
}

ExactStep::ExactStep(const Body& body) : impl_(std::make_unique<Impl>(body)) {}
ExactStep::~ExactStep() = default;

Step ExactStep::step(const State& from, const Pose& plate_pose, double dt_s) {
    const Body& body = impl_->body;
    const Columns predicted = body.predict(from, plate_pose, dt_s);
    VectorXd rhs = VectorXd::Zero(impl_->matrix.rows());
    impl_->iterations = 0;
    impl_->assemble(predicted, dt_s, rhs);
    impl_->add_nodes(dt_s, rhs, from);
    const VectorXd d = impl_->solve(rhs, dt_s);
    Step result;
    result.state.positions_m = predicted;
    for (const std::uint32_t node : body.active)
        result.state.positions_m.col(node) += d.segment<3>(impl_->unknown[node]);
    result.state.velocities_m_per_s = (result.state.positions_m - from.positions_m) / dt_s;
    result.force_n = impl_->force(from, predicted, result.state, dt_s);
    result.iterations = impl_->iterations;
    return result;
}

}  // namespace knead::bench
