// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/contact_law.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace knead::tools {
namespace {

using Block = Eigen::Matrix3d;

constexpr double kRelativeError = 1e-13;  // of the forces: a few roundings of a dense solve
constexpr double kGoodEnough = 1e-11;     // where more iterations do not help any more
constexpr int kNewtonIterations = 40;     // of one round
constexpr int kRounds = 12;
constexpr int kRoundsWithoutSlip =
    2;                        // with infinite friction, where sweeps find no more than Newton's method
constexpr int kWatched = 10;  // last iterations of a round, for what does not settle
constexpr int kSweeps = 100;  // before the next round; doubled each time
constexpr int kLocalIterations = 100;  // of one node in a sweep
constexpr double kLocalError = 1e-14;

enum class Phase { free, stick, slip };

Eigen::Vector2d projected(const Eigen::Vector2d& force, double radius) {
    const double norm = force.norm();
    return norm <= radius ? force : Eigen::Vector2d(force * (radius / norm));
}

class Solver {
  public:
    explicit Solver(const LawProblem& problem)
        : problem_(problem), count_(static_cast<Eigen::Index>(problem.nodes.size())) {
        scale_.resize(3 * count_);
        for (Eigen::Index k = 0; k < count_; ++k) {
            const Block block = diagonal_block(k);
            scale_[3 * k] = 1 / block(0, 0);
            scale_[3 * k + 1] = scale_[3 * k + 2] = 2 / (block(1, 1) + block(2, 2));
        }
        phase_.assign(problem.nodes.size(), Phase::free);
    }

    LawSolution solve(const Eigen::VectorXd& start_n, const std::vector<bool>& start_touching) {
        force_ = start_n;
        start_with(start_touching);
        LawSolution solution;
        const bool all_may_slip =
            std::none_of(problem_.nodes.begin(), problem_.nodes.end(),
                         [](const NodeLaw& law) { return std::isinf(law.friction) && !law.bilateral; });
        const int rounds = all_may_slip ? kRounds : kRoundsWithoutSlip;
        for (int round = 0; round < rounds && !solution.converged; ++round) {
            if (round > 0) {
                ++solution.fallbacks;
                sweep(kSweeps << round);
                choose_phases();
            }
            newton(solution);
        }
        solution.force_n = force_;
        solution.unsettled = unsettled_;
        for (std::size_t k = 0; k < phase_.size(); ++k) {
            solution.touching.push_back(phase_[k] != Phase::free);
            solution.slipping.push_back(phase_[k] == Phase::slip && problem_.nodes[k].friction > 0);
        }
        return solution;
    }

  private:
    [[nodiscard]] Block diagonal_block(Eigen::Index k) const {
        return problem_.compliance_m_per_n.block<3, 3>(3 * k, 3 * k);
    }
    [[nodiscard]] const NodeLaw& law(Eigen::Index k) const {
        return problem_.nodes[static_cast<std::size_t>(k)];
    }
    [[nodiscard]] Phase& phase(Eigen::Index k) { return phase_[static_cast<std::size_t>(k)]; }
    [[nodiscard]] Eigen::VectorXd displacement() const {
        return problem_.compliance_m_per_n * force_ + problem_.offset_m;
    }

    /// The first solve: what touched, without slip where there is friction.
    void start_with(const std::vector<bool>& touching) {
        for (Eigen::Index k = 0; k < count_; ++k)
            phase(k) = !touching[static_cast<std::size_t>(k)] && !law(k).bilateral ? Phase::free
                       : law(k).friction > 0 || law(k).bilateral                   ? Phase::stick
                                                                                   : Phase::slip;
    }

    /// The phase of each node that its augmented force (force - scale * displacement) points to.
    void choose_phases() {
        augmented_ = force_ - scale_.cwiseProduct(displacement());
        for (Eigen::Index k = 0; k < count_; ++k) {
            const double normal = augmented_[3 * k];
            const double radius = law(k).friction * normal;
            if (law(k).bilateral) {
                phase(k) = Phase::stick;
            } else if (!(normal > 0)) {
                phase(k) = Phase::free;
            } else {
                phase(k) = law(k).friction > 0 && augmented_.segment<2>(3 * k + 1).norm() <= radius
                               ? Phase::stick
                               : Phase::slip;
            }
        }
    }

    /// What the equations of the phases leave, and (if asked for) their derivative to the forces.
    Eigen::VectorXd equations(Eigen::MatrixXd* jacobian) {
        const Eigen::VectorXd moved = displacement();
        augmented_ = force_ - scale_.cwiseProduct(moved);
        const Eigen::MatrixXd& w = problem_.compliance_m_per_n;
        Eigen::VectorXd left(3 * count_);
        for (Eigen::Index k = 0; k < count_; ++k) {
            for (Eigen::Index i = 3 * k; i < 3 * k + 3; ++i) {
                const bool is_normal = i == 3 * k;
                const bool held = phase(k) == Phase::stick || (phase(k) == Phase::slip && is_normal);
                left[i] = held ? scale_[i] * moved[i] : force_[i];
                if (jacobian == nullptr) continue;
                if (held) {
                    jacobian->row(i) = scale_[i] * w.row(i);
                } else {
                    jacobian->row(i).setZero();
                    (*jacobian)(i, i) = 1;
                }
            }
            if (phase(k) == Phase::slip && law(k).friction > 0) slip_equations(k, left, jacobian);
        }
        return left;
    }

    /// force_t - radius * e with e the direction of the augmented force: along it the node is dragged.
    void slip_equations(Eigen::Index k, Eigen::VectorXd& left, Eigen::MatrixXd* jacobian) const {
        const Eigen::Vector2d along = augmented_.segment<2>(3 * k + 1);
        const double length = along.norm();
        if (!(length > 0)) return;  // no direction: no friction either
        const Eigen::Vector2d direction = along / length;
        const double radius = law(k).friction * std::max(augmented_[3 * k], 0.0);
        left.segment<2>(3 * k + 1) -= radius * direction;
        if (jacobian == nullptr) return;
        const Eigen::MatrixXd& w = problem_.compliance_m_per_n;
        const double turned = std::min(1.0, radius / length);
        Eigen::MatrixXd change = -scale_[3 * k + 1] * w.middleRows<2>(3 * k + 1);
        change.middleCols<2>(3 * k + 1) += Eigen::Matrix2d::Identity();
        const Eigen::Matrix2d across = Eigen::Matrix2d::Identity() - direction * direction.transpose();
        Eigen::RowVectorXd normal = -scale_[3 * k] * w.row(3 * k);
        normal[3 * k] += 1;
        jacobian->middleRows<2>(3 * k + 1) -= turned * across * change;
        if (augmented_[3 * k] > 0) jacobian->middleRows<2>(3 * k + 1) -= law(k).friction * direction * normal;
    }

    void newton(LawSolution& solution) {
        Eigen::MatrixXd jacobian(3 * count_, 3 * count_);
        unsettled_.assign(phase_.size(), false);
        for (int iteration = 0; iteration < kNewtonIterations; ++iteration) {
            const Eigen::VectorXd left = equations(&jacobian);
            const Eigen::VectorXd change = jacobian.partialPivLu().solve(-left);
            ++solution.iterations;
            if (!change.allFinite()) return;
            force_ += change;
            const std::vector<Phase> before = phase_;
            choose_phases();
            for (std::size_t k = 0; k < phase_.size(); ++k)
                if (iteration >= kNewtonIterations - kWatched && phase_[k] != before[k]) unsettled_[k] = true;
            const double error = equations(nullptr).norm();
            const double scale = force_.norm() + scale_.cwiseProduct(problem_.offset_m).norm();
            const bool stalled = iteration > 0 && error >= solution.error_n;
            solution.error_n = error;
            solution.converged = error <= kRelativeError * scale || (stalled && error <= kGoodEnough * scale);
            if (solution.converged) return;
        }
    }

    void sweep(int times) {
        if (!force_.allFinite()) force_.setZero();
        for (int n = 0; n < times; ++n)
            for (Eigen::Index k = 0; k < count_; ++k) {
                const Block block = diagonal_block(k);
                Eigen::Vector3d own = force_.segment<3>(3 * k);
                const Eigen::Vector3d others = problem_.compliance_m_per_n.middleRows<3>(3 * k) * force_ +
                                               problem_.offset_m.segment<3>(3 * k) - block * own;
                force_.segment<3>(3 * k) = alone(law(k), block, others, own);
            }
    }

    /// One node with the forces of all others given.
    static Eigen::Vector3d alone(const NodeLaw& law, const Block& block, const Eigen::Vector3d& offset,
                                 Eigen::Vector3d force) {
        if (!law.bilateral && offset[0] >= 0) return Eigen::Vector3d::Zero();
        const Eigen::Vector3d stuck = block.llt().solve(-offset);
        if (law.bilateral) return stuck;
        if (law.friction > 0 && stuck[0] >= 0 && stuck.tail<2>().norm() <= law.friction * stuck[0])
            return stuck;
        if (std::isinf(law.friction)) return Eigen::Vector3d::Zero();
        if (law.friction == 0) return {-offset[0] / block(0, 0), 0, 0};
        const double step = 1 / block.trace();
        for (int n = 0; n < kLocalIterations; ++n) {
            const Eigen::Vector3d trial = force - step * (block * force + offset);
            Eigen::Vector3d next;
            next[0] = std::max(0.0, trial[0]);
            next.tail<2>() = projected(trial.tail<2>(), law.friction * next[0]);
            const double change = (next - force).norm();
            force = next;
            if (change <= kLocalError * force.norm()) break;
        }
        return force;
    }

    const LawProblem& problem_;
    Eigen::Index count_;
    Eigen::VectorXd scale_;  // newtons per metre, to compare displacements with forces
    Eigen::VectorXd force_, augmented_;
    std::vector<Phase> phase_;
    std::vector<bool> unsettled_;
};

}  // namespace

LawSolution solve_law(const LawProblem& problem, const Eigen::VectorXd& start_n,
                      const std::vector<bool>& start_touching) {
    if (problem.nodes.empty()) {
        LawSolution nothing;
        nothing.converged = true;
        return nothing;
    }
    return Solver(problem).solve(start_n, start_touching);
}

}  // namespace knead::tools
