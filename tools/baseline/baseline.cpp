// SPDX-License-Identifier: Apache-2.0
#include "baseline/baseline.h"

#include <algorithm>
#include <cmath>

namespace knead::baseline {
namespace {

constexpr int kNone = -1;
constexpr int kLargestIterations = 2000;
/// A Newton step of this many radians leaves an error of about its square: as good as the runtime's.
constexpr double kSmallTurn = 1e-3;
constexpr int kLargestRotationSteps = 10;

void to_matrix(const std::array<double, 4>& q, double* r) {
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    r[0] = 1 - 2 * (y * y + z * z);
    r[1] = 2 * (x * y - w * z);
    r[2] = 2 * (x * z + w * y);
    r[3] = 2 * (x * y + w * z);
    r[4] = 1 - 2 * (x * x + z * z);
    r[5] = 2 * (y * z - w * x);
    r[6] = 2 * (x * z - w * y);
    r[7] = 2 * (y * z + w * x);
    r[8] = 1 - 2 * (x * x + y * y);
}

/// Newton's step of the rotation nearest to F: maximises tr(exp(w)^T B), B = R^T F, to second order.
/// Source: Kugelstadt et al., Fast Corotated FEM using Operator Splitting, 2018.
/// @return squared angle
double turn(const double* f, std::array<double, 4>& q, const double* r) {
    double b[9];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            b[3 * i + j] = r[i] * f[j] + r[3 + i] * f[3 + j] + r[6 + i] * f[6 + j];
    const double gx = b[7] - b[5], gy = b[2] - b[6], gz = b[3] - b[1];
    const double a = b[4] + b[8], d = b[0] + b[8], e = b[0] + b[4];
    const double p = -0.5 * (b[1] + b[3]), s = -0.5 * (b[2] + b[6]), t = -0.5 * (b[5] + b[7]);
    // Cofactors of the symmetric matrix [a p s; p d t; s t e].
    const double c00 = d * e - t * t, c01 = s * t - p * e, c02 = p * t - s * d;
    const double c11 = a * e - s * s, c12 = p * s - a * t, c22 = a * d - p * p;
    const double inverse = 1 / (a * c00 + p * c01 + s * c02);
    const double x = 0.5 * inverse * (c00 * gx + c01 * gy + c02 * gz);
    const double y = 0.5 * inverse * (c01 * gx + c11 * gy + c12 * gz);
    const double z = 0.5 * inverse * (c02 * gx + c12 * gy + c22 * gz);
    const std::array<double, 4> o = q;
    q = {o[0] - o[1] * x - o[2] * y - o[3] * z, o[1] + o[0] * x + o[2] * z - o[3] * y,
         o[2] + o[0] * y + o[3] * x - o[1] * z, o[3] + o[0] * z + o[1] * y - o[2] * x};
    const double norm = 1 / std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double& value : q)
        value *= norm;
    return 4 * (x * x + y * y + z * z);
}

void follow_rotation(const double* f, std::array<double, 4>& q, double* r) {
    to_matrix(q, r);
    for (int k = 0; k < kLargestRotationSteps; ++k) {
        const double angle2 = turn(f, q, r);
        to_matrix(q, r);
        if (angle2 < kSmallTurn * kSmallTurn) return;
    }
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

}  // namespace

Baseline::Baseline(const Body& body, double relative_residual)
    : body_(body),
      relative_residual_(relative_residual),
      predicted_(body.rest_m),
      rotations_(body.elements.size()) {
    make_pattern();
    const std::size_t size = 3 * body.active.size();
    for (Vector* v : {&displacement_, &residual_, &direction_, &product_, &preconditioned_})
        v->assign(size, 0.0);
    load_.assign(3 * (body.active.size() + body.plate.size()), 0.0);
    diagonal_inverse_.resize(body.active.size());
    reset();
}

void Baseline::reset() {
    state_ = body_.at_rest();
    std::fill(rotations_.begin(), rotations_.end(), Quaternion{1, 0, 0, 0});
}

void Baseline::make_pattern() {
    row_of_node_.assign(static_cast<std::size_t>(body_.rest_m.cols()), kNone);
    int next = 0;
    for (const auto* nodes : {&body_.active, &body_.plate})
        for (const std::uint32_t node : *nodes)
            row_of_node_[node] = next++;
    const auto active = static_cast<int>(body_.active.size());
    std::vector<std::vector<int>> columns(static_cast<std::size_t>(next));
    for (const Body::Element& e : body_.elements)
        for (const std::uint32_t a : e.nodes)
            for (const std::uint32_t b : e.nodes)
                if (row_of_node_[a] != kNone && row_of_node_[b] != kNone && row_of_node_[b] < active)
                    columns[static_cast<std::size_t>(row_of_node_[a])].push_back(row_of_node_[b]);
    row_start_.assign(1, 0);
    for (std::size_t row = 0; row < columns.size(); ++row) {
        std::sort(columns[row].begin(), columns[row].end());
        columns[row].erase(std::unique(columns[row].begin(), columns[row].end()), columns[row].end());
        for (const int c : columns[row]) {
            if (c == static_cast<int>(row)) diagonal_.push_back(static_cast<int>(column_.size()));
            column_.push_back(c);
        }
        row_start_.push_back(static_cast<int>(column_.size()));
    }
    blocks_.resize(column_.size());
    place_.resize(body_.elements.size());
    for (std::size_t t = 0; t < place_.size(); ++t)
        for (std::size_t k = 0; k < 16; ++k) {
            const int row = row_of_node_[body_.elements[t].nodes[k / 4]];
            const int column = row_of_node_[body_.elements[t].nodes[k % 4]];
            place_[t][k] = kNone;
            if (row == kNone || column == kNone || column >= active) continue;
            const auto first = column_.begin() + row_start_[static_cast<std::size_t>(row)];
            const auto last = column_.begin() + row_start_[static_cast<std::size_t>(row) + 1];
            place_[t][k] = static_cast<int>(std::lower_bound(first, last, column) - column_.begin());
        }
}

void Baseline::add_blocks(std::size_t element, const double* g, double dt_s) {
    const Body::Element& e = body_.elements[element];
    const double mu = dt_s * dt_s * e.volume_m3 * e.mu_pa;
    const double lambda = dt_s * dt_s * e.volume_m3 * e.lambda_pa;
    for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = a; b < 4; ++b) {
            const double* const ga = g + 3 * a;
            const double* const gb = g + 3 * b;
            const double both = mu * (ga[0] * gb[0] + ga[1] * gb[1] + ga[2] * gb[2]);
            double block[9];
            for (std::size_t i = 0; i < 3; ++i) {
                const double la = lambda * ga[i];
                const double mb = mu * gb[i];
                for (std::size_t j = 0; j < 3; ++j)
                    block[3 * i + j] = la * gb[j] + mb * ga[j];
                block[4 * i] += both;
            }
            if (const int place = place_[element][4 * a + b]; place != kNone)
                for (std::size_t k = 0; k < 9; ++k)
                    blocks_[static_cast<std::size_t>(place)][k] += block[k];
            if (const int place = place_[element][4 * b + a]; place != kNone && a != b)
                for (std::size_t i = 0; i < 3; ++i)
                    for (std::size_t j = 0; j < 3; ++j)
                        blocks_[static_cast<std::size_t>(place)][3 * i + j] += block[3 * j + i];
        }
}

void Baseline::assemble(double dt_s) {
    std::fill(blocks_.begin(), blocks_.end(), Block{});
    std::fill(load_.begin(), load_.end(), 0.0);
    const double* const x = predicted_.data();
    for (std::size_t t = 0; t < body_.elements.size(); ++t) {
        const Body::Element& e = body_.elements[t];
        const double* const h = e.shape_gradients.data();  // 4 gradients of 3 numbers
        double f[9] = {};
        for (std::size_t a = 0; a < 4; ++a) {
            const double* const xa = x + 3 * std::size_t{e.nodes[a]};
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j)
                    f[3 * i + j] += xa[i] * h[3 * a + j];
        }
        double r[9];
        follow_rotation(f, rotations_[t], r);
        double trace = -3;
        for (int k = 0; k < 9; ++k)
            trace += r[k] * f[k];
        double stress[9];
        for (int k = 0; k < 9; ++k)
            stress[k] = 2 * e.mu_pa * (f[k] - r[k]) + e.lambda_pa * trace * r[k];
        const double scale = dt_s * dt_s * e.volume_m3;
        double rotated[12];
        for (std::size_t a = 0; a < 4; ++a) {
            const int row = row_of_node_[e.nodes[a]];
            for (std::size_t i = 0; i < 3; ++i) {
                const double* const ha = h + 3 * a;
                rotated[3 * a + i] = r[3 * i] * ha[0] + r[3 * i + 1] * ha[1] + r[3 * i + 2] * ha[2];
                if (row != kNone)
                    load_[3 * static_cast<std::size_t>(row) + i] -=
                        scale *
                        (stress[3 * i] * ha[0] + stress[3 * i + 1] * ha[1] + stress[3 * i + 2] * ha[2]);
            }
        }
        add_blocks(t, rotated, dt_s);
    }
    const double c = body_.damping_per_s;
    for (std::size_t i = 0; i < body_.active.size(); ++i) {
        const std::uint32_t node = body_.active[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<Eigen::Index>(k);
            blocks_[static_cast<std::size_t>(diagonal_[i])][4 * k] += body_.mass_kg[node] * (1 + c * dt_s);
            load_[3 * i + k] += dt_s * dt_s * body_.mass_kg[node] *
                                (body_.gravity_m_per_s2[axis] - c * state_.velocities_m_per_s(axis, node));
        }
    }
}

void Baseline::invert_diagonal() {
    for (std::size_t i = 0; i < diagonal_inverse_.size(); ++i) {
        const Block& m = blocks_[static_cast<std::size_t>(diagonal_[i])];
        Block& inverse = diagonal_inverse_[i];
        inverse = {m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
                   m[5] * m[6] - m[3] * m[8], m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
                   m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
        const double scale = 1 / (m[0] * inverse[0] + m[1] * inverse[3] + m[2] * inverse[6]);
        for (double& value : inverse)
            value *= scale;
    }
}

void Baseline::multiply(const Vector& x, Vector& out) const {
    for (std::size_t row = 0; row < body_.active.size(); ++row) {
        double s0 = 0, s1 = 0, s2 = 0;
        const int last = row_start_[row + 1];
        for (int k = row_start_[row]; k < last; ++k) {
            const double* const m = blocks_[static_cast<std::size_t>(k)].data();
            const double* const v =
                x.data() + 3 * static_cast<std::size_t>(column_[static_cast<std::size_t>(k)]);
            s0 += m[0] * v[0] + m[1] * v[1] + m[2] * v[2];
            s1 += m[3] * v[0] + m[4] * v[1] + m[5] * v[2];
            s2 += m[6] * v[0] + m[7] * v[1] + m[8] * v[2];
        }
        out[3 * row] = s0;
        out[3 * row + 1] = s1;
        out[3 * row + 2] = s2;
    }
}

void Baseline::precondition(const Vector& r, Vector& z) const {
    for (std::size_t i = 0; i < diagonal_inverse_.size(); ++i) {
        const Block& m = diagonal_inverse_[i];
        const double* const v = r.data() + 3 * i;
        for (std::size_t k = 0; k < 3; ++k)
            z[3 * i + k] = m[3 * k] * v[0] + m[3 * k + 1] * v[1] + m[3 * k + 2] * v[2];
    }
}

void Baseline::solve() {
    std::fill(displacement_.begin(), displacement_.end(), 0.0);
    std::copy_n(load_.begin(), residual_.size(), residual_.begin());
    const double target = relative_residual_ * relative_residual_ * dot(residual_, residual_);
    precondition(residual_, preconditioned_);
    direction_ = preconditioned_;
    double rz = dot(residual_, preconditioned_);
    for (iterations_ = 0; iterations_ < kLargestIterations; ++iterations_) {
        if (dot(residual_, residual_) <= target) return;
        multiply(direction_, product_);
        const double alpha = rz / dot(direction_, product_);
        for (std::size_t i = 0; i < residual_.size(); ++i) {
            displacement_[i] += alpha * direction_[i];
            residual_[i] -= alpha * product_[i];
        }
        precondition(residual_, preconditioned_);
        const double next = dot(residual_, preconditioned_);
        for (std::size_t i = 0; i < residual_.size(); ++i)
            direction_[i] = preconditioned_[i] + (next / rz) * direction_[i];
        rz = next;
    }
}

Eigen::Vector3d Baseline::accept(double dt_s) {
    for (std::size_t i = 0; i < body_.active.size(); ++i)
        for (int k = 0; k < 3; ++k)
            predicted_(k, body_.active[i]) += displacement_[3 * i + static_cast<std::size_t>(k)];
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (std::size_t p = 0; p < body_.plate.size(); ++p) {
        const std::uint32_t node = body_.plate[p];
        const std::size_t row = body_.active.size() + p;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<Eigen::Index>(k);
            double elastic = load_[3 * row + k];
            for (int b = row_start_[row]; b < row_start_[row + 1]; ++b)
                for (std::size_t j = 0; j < 3; ++j)
                    elastic -=
                        blocks_[static_cast<std::size_t>(b)][3 * k + j] *
                        displacement_[3 * static_cast<std::size_t>(column_[static_cast<std::size_t>(b)]) + j];
            const double v = (predicted_(axis, node) - state_.positions_m(axis, node)) / dt_s;
            const double inertia = (v - state_.velocities_m_per_s(axis, node)) / dt_s +
                                   body_.damping_per_s * v - body_.gravity_m_per_s2[axis];
            force[axis] += elastic / (dt_s * dt_s) - body_.mass_kg[node] * inertia;
        }
    }
    state_.velocities_m_per_s = (predicted_ - state_.positions_m) / dt_s;
    state_.positions_m = predicted_;
    return force;
}

Eigen::Vector3d Baseline::step(const Pose& plate_pose, double dt_s) {
    predicted_ = body_.predict(state_, plate_pose, dt_s);
    assemble(dt_s);
    invert_diagonal();
    solve();
    return accept(dt_s);
}

}  // namespace knead::baseline
