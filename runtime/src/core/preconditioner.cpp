// SPDX-License-Identifier: Apache-2.0
#include "core/preconditioner.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numeric>

namespace knead::core {
namespace {

/// A dt that differs by no more than this factor is as good as the one the numbers were made for: the
/// condition number becomes its square at most.
constexpr Real kSameDt = 1.25;
/// Steps that must ask for about the same other dt before numbers are made for it: jitter does not last.
constexpr int kLastingSteps = 8;
/// Work on new numbers, floating-point operations per second of simulated time: some 10 % of a core.
constexpr Real kWorkPerSecond = 1e9;
/// Mean rotation from which on it pays to turn the sparse inverse: mass, which outweighs stiffness there,
/// does not turn.
constexpr Real kTurnSparse_rad = 0.15;
/// Time in which the rotations of all nodes are taken anew, a share in each step; and the most shares.
constexpr Real kRotationsIn_s = 32e-3;
constexpr std::uint32_t kRotationShares = 32;
/// Free nodes that tools may touch, up to which the correction for contact is kept: its table grows with the
/// square, and takes 9 MB here.
constexpr std::size_t kMostTouchable = 512;
/// Nodes that the correction takes in at a time; others are projected until their turn comes.
constexpr std::size_t kInsertions = 16;
/// Held directions that have turned by less (squared) are the same as far as the tool's stiffness goes.
constexpr Real kSameHold = 1e-3;
/// Beyond this contrast stiff matter must be followed at once: a lag of its rotation weighs too much.
constexpr double kLaggingContrast = 1e2;

bool about_same(Real a, Real b) {
    return a <= kSameDt * b && b <= kSameDt * a;
}

FactorStorage stored(knead::FactorStorage storage) {
    switch (storage) {
        case knead::FactorStorage::fixed16:
            return FactorStorage::fixed_point_16;
        case knead::FactorStorage::float32:
            return FactorStorage::single_precision;
        case knead::FactorStorage::float64:
            break;
    }
    return FactorStorage::double_precision;
}

Real largest_eigenvalue(const Mat& symmetric) {
    return Eigen::SelfAdjointEigenSolver<Mat>()
        .computeDirect(symmetric, Eigen::EigenvaluesOnly)
        .eigenvalues()
        .maxCoeff();
}

/// Bound of the largest eigenvalue of every node's diagonal block of K.
std::vector<Real> node_stiffnesses(const Model& model) {
    std::vector<Real> result(model.free_count, 0);
    for (const Element& element : model.elements) {
        const Real modulus = 2 * element.mu_volume + element.lambda_volume;
        const Vec first = -element.rest_inverse.colwise().sum();
        for (int k = 0; k < 4; ++k) {
            const std::uint32_t node = element.nodes[static_cast<std::size_t>(k)];
            const Real squared =
                k == 0 ? first.squaredNorm() : Real(element.rest_inverse.row(k - 1).squaredNorm());
            if (node < model.free_count) result[node] += modulus * squared;
        }
    }
    return result;
}

}  // namespace

template <class S>
Preconditioner<S>::Preconditioner(const Model& model, const Stiffness<S>& at_rest, const Numerics& numerics,
                                  SimdTarget target, Real dt_s, const std::vector<std::uint32_t>& touchable)
    : model_(model),
      fields_(kernels(target).field<S>()),
      expected_dt_s_(dt_s),
      dt_s_(dt_s),
      rotation_shares_(numerics.contrast <= kLaggingContrast ? kRotationShares : 1),
      rotations_(model, at_rest, kernels(target)),
      matrix_(model, RestMatrix::Kind::elastic),
      sparse_(matrix_.pattern(), kernels(target)),
      turned_(model.rest_m.size()),
      held_(touchable.size()),
      own_inverse_(model.bonded.size(), Mat::Zero()),
      packed_float_(NodeRotations<S>::packed_size(model.free_count)),
      solved_float_(NodeRotations<S>::packed_size(model.free_count)),
      packed_double_(NodeRotations<S>::packed_size(model.free_count)),
      solved_double_(NodeRotations<S>::packed_size(model.free_count)),
      node_stiffness_(node_stiffnesses(model)),
      held_stiffness_(model.bonded.size(), 0),
      felt_(touchable.size()),
      felt_at_(model.free_count, 0),
      felt_stiffness_(model.bonded.size(), Mat::Zero()),
      felt_alike_(model.bonded.size()),
      tool_inverse_(model.bonded.size(), Mat::Zero()),
      stiffness_per_s2_(std::accumulate(node_stiffness_.begin(), node_stiffness_.end(), Real(0)) /
                        model.free_mass_kg) {
    if (numerics.preconditioner == knead::Preconditioner::laplacian)
        laplacian_matrix_ = std::make_unique<RestMatrix>(model, RestMatrix::Kind::laplacian);
    if (numerics.preconditioner != knead::Preconditioner::sparse_inverse) {
        const RestMatrix& factored = laplacian() ? *laplacian_matrix_ : matrix_;
        factor_ = std::make_unique<SupernodalFactor>(factored.pattern(), factored.block_size(),
                                                     stored(numerics.factor_storage), target);
        scratch_ = std::make_unique<SupernodalFactor::Scratch>(*factor_);
    }
    if (factor_ && !laplacian() && !touchable.empty() && touchable.size() <= kMostTouchable) {
        correction_ = std::make_unique<ContactCorrection>(*factor_, touchable, model.bonded.size(),
                                                          ContactCorrection::kColumnBytes, target);
        correction_scratch_ = std::make_unique<ContactCorrection::Scratch>(*correction_);
    }
    find_borders(at_rest);
    make_for(dt_s);
}

template <class S>
bool Preconditioner<S>::sparse_suffices(Real dt_s) const noexcept {
    return !factor_ || dt_s * dt_s * stiffness_per_s2_ <= kSparseInverseMaxStiffness;
}

template <class S>
bool Preconditioner<S>::is_close(Real dt_s) const noexcept {
    return about_same(dt_s, dt_s_) &&
           (!uses_sparse_ || dt_s_ * dt_s_ * stiffness_per_s2_ <= kSparseInverseMaxStiffness);
}

/// Everything for one dt at once: when loading and on reset.
template <class S>
void Preconditioner<S>::make_for(Real dt_s) noexcept {
    dt_s_ = dt_s;
    const Real inertia = 1 + model_.damping_per_s * dt_s;
    matrix_.set(dt_s, inertia);
    matrix_dt_s_ = dt_s;
    if (laplacian()) laplacian_matrix_->set(dt_s, inertia);
    uses_sparse_ = sparse_suffices(dt_s);
    if (!uses_sparse_) {
        // Refused: not positive definite as far as rounding can tell. The sparse inverse always is.
        uses_sparse_ = !factor_->factorise((laplacian() ? *laplacian_matrix_ : matrix_).values());
        if (!uses_sparse_ && correction_) correction_->build();
    }
    if (uses_sparse_) sparse_.make(matrix_.values(), 0, sparse_.row_count());
    find_responses();
}

template <class S>
void Preconditioner<S>::find_borders(const Stiffness<S>& at_rest) {
    borders_.resize(model_.bonded.size());
    NodeField<S> motion(model_.rest_m.size());
    for (std::size_t k = 0; k < borders_.size(); ++k) {
        const Model::Range nodes = model_.bonded[k];
        if (nodes.begin == nodes.end) continue;
        for (int axis = 0; axis < 3; ++axis) {
            motion.fill_zero();
            for (std::uint32_t i = nodes.begin; i < nodes.end; ++i)
                motion.set(i, Vec::Unit(axis));
            NodeField<S>& force = borders_[k].force[static_cast<std::size_t>(axis)];
            force = NodeField<S>(model_.rest_m.size());
            at_rest.add_product(S(1), motion, force);
            for (std::uint32_t i = nodes.begin; i < nodes.end; ++i)
                borders_[k].stiffness.col(axis) += force.get(i);
            for (std::size_t i = model_.free_count; i < model_.rest_m.size(); ++i)
                force.set(i, Vec::Zero());
            borders_[k].response[static_cast<std::size_t>(axis)] = NodeField<S>(model_.rest_m.size());
        }
    }
}

template <class S>
void Preconditioner<S>::find_responses() noexcept {
    const Real dt2 = dt_s_ * dt_s_;
    for (Border& border : borders_) {
        if (border.force[0].size() == 0) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            solve(border.force[axis], border.response[axis]);
            fields_.scale(border.response[axis].size(), static_cast<S>(dt2), border.response[axis].data());
        }
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                border.following_kg(static_cast<int>(i), static_cast<int>(j)) =
                    dt2 * static_cast<Real>(fields_.dot(border.force[i].size(), border.force[i].data(),
                                                        border.response[j].data()));
            }
        }
        border.following_kg = (0.5 * (border.following_kg + border.following_kg.transpose())).eval();
        border.sensitivity = largest_eigenvalue(border.following_kg);
    }
}

template <class S>
void Preconditioner<S>::reset() noexcept {
    rotations_.reset();
    if (correction_) correction_->clear();
    corrects_ = false;
    felt_count_ = 0;
    std::fill(held_stiffness_.begin(), held_stiffness_.end(), Real(0));
    wanted_dt_s_ = 0;
    steps_wanted_ = 0;
    // Steps depend on nothing but the steps since the reset.
    if (dt_s_ != expected_dt_s_ || job_ != Job::none) make_for(expected_dt_s_);
    job_ = Job::none;
}

template <class S>
void Preconditioner<S>::begin_step(const System<S>& system) noexcept {
    turn(system);
    follow(system.dt_s);
}

template <class S>
void Preconditioner<S>::turn(const System<S>& system) noexcept {
    if (uses_sparse_ || !laplacian()) {
        const auto shares = static_cast<std::uint32_t>(kRotationsIn_s / system.dt_s);
        rotations_.update(system.stiffness, std::clamp(shares, 1u, rotation_shares_));
    }
    turns_ = !uses_sparse_ || rotations_.mean_angle_rad() > kTurnSparse_rad;
}

/// Numbers for another dt, once it lasts.
template <class S>
void Preconditioner<S>::follow(Real dt_s) noexcept {
    if (job_ != Job::none) {
        if (!advance(static_cast<std::uint64_t>(kWorkPerSecond * dt_s))) return;
        job_ = Job::none;
        steps_wanted_ = 0;
        return;
    }
    if (about_same(dt_s, dt_s_)) {
        steps_wanted_ = 0;
        return;
    }
    steps_wanted_ = about_same(dt_s, wanted_dt_s_) ? steps_wanted_ + 1 : 1;
    wanted_dt_s_ = dt_s;
    if (steps_wanted_ < kLastingSteps) return;
    const Real inertia = 1 + model_.damping_per_s * dt_s;
    matrix_.set(dt_s, inertia);
    matrix_dt_s_ = dt_s;
    if (laplacian()) laplacian_matrix_->set(dt_s, inertia);
    next_row_ = 0;
    job_ = sparse_suffices(dt_s) ? Job::sparse : Job::factor;
    if (job_ == Job::factor) factor_->begin((laplacian() ? *laplacian_matrix_ : matrix_).values());
}

/// A piece of the job. @return whether it is over
template <class S>
bool Preconditioner<S>::advance(std::uint64_t work) noexcept {
    if (job_ == Job::sparse) {
        // Rows of two different dt go together: each row on its own is as good as any.
        const auto rows =
            static_cast<std::uint32_t>(std::max<std::uint64_t>(1, work / sparse_.largest_row()));
        const std::uint32_t last = std::min(sparse_.row_count(), next_row_ + rows);
        sparse_.make(matrix_.values(), next_row_, last);
        next_row_ = last;
        if (next_row_ < sparse_.row_count()) return false;
        uses_sparse_ = true;
    } else if (job_ == Job::factor) {
        const Progress progress = correction_ ? factor_->advance_staged(work) : factor_->advance(work);
        if (progress == Progress::working) return false;
        if (progress == Progress::refused) return true;
        if (correction_) {
            correction_->begin();
            job_ = Job::contact;
            return false;
        }
        uses_sparse_ = false;
    } else {
        if (correction_->advance(work) == Progress::working) return false;
        correction_->adopt();
        uses_sparse_ = false;
    }
    dt_s_ = wanted_dt_s_;
    find_responses();
    return true;
}

template <class S>
void Preconditioner<S>::hold(const System<S>& system) noexcept {
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        const bool bonded = borders_[k].force[0].size() > 0;
        const Mat felt = dt_s_ * dt_s_ * borders_[k].stiffness - borders_[k].following_kg;
        tool_inverse_[k] = system.tool_diagonal_kg(k) * Mat::Identity();
        if (bonded) tool_inverse_[k] += felt;
    }
    const Real dt2 = system.dt_s * system.dt_s;
    find_held_stiffness(system);
    for (const Constraint& c : system.constraints) {
        tool_inverse_[c.tool] +=
            (system.inertia * model_.mass_kg[c.node] + dt2 * node_stiffness_[c.node]) * c.held;
    }
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        if (system.tools[k].moves) tool_inverse_[k] = Mat(tool_inverse_[k].inverse());
    }
    correct_for(system);
}

/// What a tool feels of the nodes that it holds, with all others still: the sum of held K held over all pairs
/// of them, at rest. Found anew when they change.
template <class S>
void Preconditioner<S>::find_held_stiffness(const System<S>& system) noexcept {
    const std::vector<Constraint>& constraints = system.constraints;
    bool same = constraints.size() == felt_count_;
    for (std::size_t k = 0; same && k < felt_count_; ++k) {
        same = constraints[k].node == felt_[k].node && constraints[k].tool == felt_[k].tool &&
               (constraints[k].held - felt_[k].held).squaredNorm() < kSameHold;
    }
    if (same) return;
    felt_count_ = std::min(constraints.size(), felt_.size());
    std::fill(felt_stiffness_.begin(), felt_stiffness_.end(), Mat::Zero());
    std::fill(felt_alike_.begin(), felt_alike_.end(), FeltAlike{});
    for (std::uint32_t k = 0; k < felt_count_; ++k) {
        FeltAlike& alike = felt_alike_[constraints[k].tool];
        if (alike.held.isZero(0)) alike.held = constraints[k].held;
        felt_[k] = {constraints[k].node, constraints[k].tool, constraints[k].held == alike.held,
                    constraints[k].held};
        felt_at_[constraints[k].node] = k;
    }
    const MatrixPattern& pattern = matrix_.pattern();
    const Real inertia = 1 + model_.damping_per_s * matrix_dt_s_;
    for (std::uint32_t k = 0; k < felt_count_; ++k) {
        const Felt& column = felt_[k];
        for (std::uint32_t e = pattern.column_begin[column.node]; e < pattern.column_begin[column.node + 1];
             ++e) {
            const std::uint32_t row = pattern.row_nodes[e];
            const std::uint32_t at = felt_at_[row];
            if (at >= felt_count_ || felt_[at].node != row || felt_[at].tool != column.tool) continue;
            Mat block = Eigen::Map<const Mat>(matrix_.values() + std::size_t{9} * e);
            if (row == column.node) block.diagonal().array() -= inertia * model_.mass_kg[row];
            if (column.alike && felt_[at].alike) {
                FeltAlike& alike = felt_alike_[column.tool];
                (row == column.node ? alike.own : alike.between) += block;
                continue;
            }
            const Mat felt = felt_[at].held * block * column.held;
            felt_stiffness_[column.tool] += row == column.node ? felt : Mat(felt + felt.transpose());
        }
    }
    for (std::size_t t = 0; t < held_stiffness_.size(); ++t) {
        const FeltAlike& alike = felt_alike_[t];
        const Mat sum = alike.own + alike.between + alike.between.transpose();
        felt_stiffness_[t] += alike.held * sum * alike.held;
    }
    for (std::size_t t = 0; t < held_stiffness_.size(); ++t)
        held_stiffness_[t] = largest_eigenvalue(felt_stiffness_[t]) / (matrix_dt_s_ * matrix_dt_s_);
}

/// Lets the correction follow the constraints. A tool that moves and is bonded has a border of its own, which
/// the correction does not know: then held nodes of other tools are left to the projection.
template <class S>
void Preconditioner<S>::correct_for(const System<S>& system) noexcept {
    corrects_ = correction_ != nullptr && !uses_sparse_ && !system.constraints.empty();
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        const bool moves = system.tools[k].moves;
        own_inverse_[k] = moves ? Mat(Mat::Identity() / system.tool_diagonal_kg(k)) : Mat(Mat::Zero());
        if (moves && borders_[k].force[0].size() > 0) corrects_ = false;
    }
    if (!corrects_) {
        if (correction_) correction_->clear();
        return;
    }
    std::size_t count = 0;
    for (const Constraint& c : system.constraints) {
        if (count < held_.size()) held_[count++] = {c.node, c.tool, c.held, rotations_.rotation(c.node)};
    }
    (void)correction_->update(held_.data(), count, own_inverse_.data(), kInsertions);
}

template <class S>
void Preconditioner<S>::apply(const System<S>& system, const Unknowns<S>& residual,
                              Unknowns<S>& out) const noexcept {
    if (corrects_) {
        if (in_double())
            solve_corrected(packed_double_, solved_double_, residual, out);
        else
            solve_corrected(packed_float_, solved_float_, residual, out);
        system.expand(out);
        return;
    }
    solve(residual.nodes, out.nodes);
    const std::size_t free = run_of(model_.free_count);
    for (std::size_t k = 0; k < system.tools.size(); ++k) {
        out.tools[k].setZero();
        if (!system.tools[k].moves) continue;
        const Border& border = borders_[k];
        const bool follows = border.force[0].size() > 0;
        Vec rest = residual.tools[k];
        for (std::size_t axis = 0; follows && axis < 3; ++axis) {
            rest[static_cast<int>(axis)] -=
                static_cast<Real>(fields_.dot(free, border.response[axis].data(), residual.nodes.data()));
        }
        out.tools[k] = tool_inverse_[k] * rest;
        for (std::size_t axis = 0; follows && axis < 3; ++axis) {
            fields_.add_scaled(free, out.nodes.data(), static_cast<S>(-out.tools[k][static_cast<int>(axis)]),
                               border.response[axis].data(), out.nodes.data());
        }
    }
    system.expand(out);
}

template <class S>
template <class T>
void Preconditioner<S>::solve_with(AlignedArray<T>& packed, const NodeField<S>& residual,
                                   NodeField<S>& out) const noexcept {
    if (!laplacian()) {
        rotations_.turn_back(residual, packed.data());
        factor_->solve(packed.data(), packed.data(), *scratch_);
        rotations_.turn(packed.data(), out);
        return;
    }
    // The same whatever the rotations.
    for (std::size_t i = 0; i < model_.free_count; ++i) {
        for (std::size_t k = 0; k < 3; ++k)
            packed[3 * i + k] = static_cast<T>(residual.data()[4 * i + k]);
    }
    factor_->solve(packed.data(), packed.data(), *scratch_);
    for (std::size_t i = 0; i < model_.free_count; ++i) {
        for (std::size_t k = 0; k < 3; ++k)
            out.data()[4 * i + k] = static_cast<S>(packed[3 * i + k]);
    }
}

template <class S>
template <class T>
void Preconditioner<S>::solve_corrected(AlignedArray<T>& packed, AlignedArray<T>& solved,
                                        const Unknowns<S>& residual, Unknowns<S>& out) const noexcept {
    rotations_.turn_back(residual.nodes, packed.data());
    correction_->apply(packed.data(), residual.tools.data(), solved.data(), out.tools.data(),
                       *correction_scratch_);
    rotations_.turn(solved.data(), out.nodes);
}

template <class S>
void Preconditioner<S>::solve(const NodeField<S>& residual, NodeField<S>& out) const noexcept {
    if (uses_sparse_) {
        if (!turns_) {
            sparse_.apply(residual, out);
            return;
        }
        rotations_.turn_back(residual, turned_);
        sparse_.apply(turned_, turned_);
        rotations_.turn(turned_, out);
    } else if (in_double()) {
        solve_with(packed_double_, residual, out);
    } else {
        solve_with(packed_float_, residual, out);
    }
}

template <class S>
bool Preconditioner<S>::knows_force_owed(const System<S>& system, std::size_t tool) const noexcept {
    return !system.tools[tool].moves && borders_[tool].force[0].size() > 0 && about_same(system.dt_s, dt_s_);
}

template <class S>
Vec Preconditioner<S>::force_owed(const System<S>& system, std::size_t tool,
                                  const NodeField<S>& residual) const noexcept {
    Vec force = Vec::Zero();
    const Border& border = borders_[tool];
    if (!knows_force_owed(system, tool)) return force;
    const std::size_t free = run_of(model_.free_count);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        force[static_cast<int>(axis)] =
            -static_cast<Real>(fields_.dot(free, border.response[axis].data(), residual.data()));
    }
    return force / (system.dt_s * system.dt_s);
}

template <class S>
Real Preconditioner<S>::force_sensitivity(const System<S>& system, std::size_t tool) const noexcept {
    const ToolUnknown& unknown = system.tools[tool];
    if (unknown.moves) {
        return unknown.rate_n_per_m * unknown.rate_n_per_m / system.tool_diagonal_kg(tool);
    }
    const Real dt2 = system.dt_s * system.dt_s;
    // The response grows with 1 / dt, so that of a shorter dt is a bound; of a longer one it is none.
    const Real still = dt2 * borders_[tool].stiffness.trace();
    const Real following = system.dt_s >= dt_s_
                               ? borders_[tool].sensitivity * (dt2 * dt2) / (dt_s_ * dt_s_ * dt_s_ * dt_s_)
                               : still;
    return (std::min(still, following) + dt2 * held_stiffness_[tool]) / (dt2 * dt2);
}

template <class S>
std::size_t Preconditioner<S>::factor_bytes() const noexcept {
    return uses_sparse_ ? sparse_.bytes() : factor_->panel_bytes();
}

template class Preconditioner<float>;
template class Preconditioner<double>;

}  // namespace knead::core
