// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/contact_newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.h"

namespace knead::tools {
namespace {

constexpr double kSufficientDecrease = 1e-4;  // Armijo's share of the decrease that the slope promises
constexpr double kSmallestStep = 1e-10;
// Promised decreases below this share of the merit drown in the rounding of its sums: the step is then taken
// whole and the conditions of contact judge it. So they do below unseen_j(), where at rest there is no merit
// to be a share of.
constexpr double kUnseenDecrease = 1e-9;
constexpr double kSupport = 30;  // of the largest stiffness of a tetrahedron: stiff, and harmless to rounding
constexpr double kPenaltyMargin = 2;     // an exact penalty must exceed the largest force
constexpr double kCatchTolerance = 0.1;  // of the limit of the gap: what is caught was not yet a failure

/// One Newton iteration's view of the contact problem.
class Iteration {
  public:
    /// @param unseen_j promised decreases that are left to the conditions of contact
    Iteration(StepModel& model, FreeSystem& system, const Eigen::VectorXd& target_m, ContactSet& set,
              double unseen_j)
        : model_(model), system_(system), target_(target_m), set_(set), unseen_j_(unseen_j) {}

    bool prepare(const Eigen::VectorXd& positions_m);
    void solve_laws(const ContactLimits& limits, double catch_tolerance_m, ContactEffort& effort);
    bool advance(Eigen::VectorXd& positions_m);

  private:
    [[nodiscard]] std::vector<NodeBlock> surface_curvature() const;
    [[nodiscard]] std::vector<NodeBlock> supports() const;
    [[nodiscard]] Eigen::VectorXd support_forces() const;
    bool factorise();
    void respond_to_known();
    [[nodiscard]] LawProblem law_problem() const;
    [[nodiscard]] LawSolution solve_once(ContactEffort& effort) const;
    bool let_slide(const std::vector<bool>& unsettled);
    void solve_known(ContactEffort& effort);
    [[nodiscard]] Eigen::VectorXd friction_forces() const;
    [[nodiscard]] double violation_m(const Eigen::VectorXd& positions_m) const;

    StepModel& model_;
    FreeSystem& system_;
    const Eigen::VectorXd& target_;
    ContactSet& set_;
    double unseen_j_;
    bool factorised_ = false;
    std::vector<NodeBlock> support_;  // those in the factor
    Eigen::VectorXd positions_, gradient_, alone_, direction_;
    std::vector<Candidate*> known_;
    std::vector<std::uint32_t> responding_;  // nodes whose responses are there
    Eigen::MatrixXd responses_;              // three columns for each
};

std::vector<NodeBlock> Iteration::surface_curvature() const {
    std::vector<NodeBlock> blocks;
    for (const Candidate& candidate : set_.candidates()) {
        const ToolSurface& surface = set_.surfaces()[candidate.tool];
        const bool slides = candidate.touching && (candidate.law.friction == 0 || candidate.slipping);
        if (!slides || !surface.is_curved()) continue;
        const Eigen::Matrix3d& turn = surface.rotation();
        const Eigen::Vector3d local = surface.to_local(positions_.segment<3>(first_unknown(candidate.node)));
        const double normal_n = candidate.frame.col(0).dot(candidate.force_n);
        const Eigen::Matrix3d curvature =
            turn * surface.nearest(local).gap_curvature_per_m * turn.transpose();
        blocks.push_back({candidate.node, -normal_n * curvature});
    }
    return blocks;
}

/// Springs on touching nodes, along the directions in which they are held.
///
/// A body that the tool keeps from buckling has no positive definite second derivative while the nodes in
/// contact count as free. The springs' rest state is where the laws put the nodes, so that they carry no
/// force in a solution: they leave it as it is, and keep Newton's method quadratic.
std::vector<NodeBlock> Iteration::supports() const {
    std::vector<NodeBlock> blocks;
    for (const Candidate& candidate : set_.candidates()) {
        if (!candidate.touching || !candidate.has_plane) continue;
        const Eigen::Vector3d normal = candidate.frame.col(0);
        const bool stuck = candidate.keeps_anchor || (candidate.law.friction > 0 && !candidate.slipping);
        const Eigen::Matrix3d held =
            stuck ? Eigen::Matrix3d::Identity() : Eigen::Matrix3d(normal * normal.transpose());
        blocks.push_back(
            {candidate.node, kSupport * model_.objective().body->largest_stiffness_n_per_m() * held});
    }
    return blocks;
}

/// [3 nodes] derivative of the supports' energy at the positions, for the rest states as the laws have them.
Eigen::VectorXd Iteration::support_forces() const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(positions_.size());
    for (const NodeBlock& support : support_)
        for (const Candidate& candidate : set_.candidates()) {
            if (candidate.node != support.node || !candidate.touching) continue;
            const Eigen::Index node = first_unknown(candidate.node);
            const Eigen::Vector3d place = positions_.segment<3>(node);
            Eigen::Vector3d off = candidate.frame.transpose() * (place - candidate.anchor_m);
            off[0] = candidate.frame.col(0).dot(place - candidate.foot_m);
            result.segment<3>(node) += support.block_n_per_m * (candidate.frame * off);
        }
    return result;
}

bool Iteration::factorise() {
    const std::vector<NodeBlock> curved = surface_curvature();
    if (model_.factorise(system_, positions_, Curvature::exact, curved)) return true;
    support_ = supports();
    std::vector<NodeBlock> blocks = curved;
    blocks.insert(blocks.end(), support_.begin(), support_.end());
    if (!support_.empty() && model_.factorise(system_, positions_, Curvature::exact, blocks)) return true;
    support_.clear();
    return model_.factorise(system_, positions_, Curvature::projected, {});
}

bool Iteration::prepare(const Eigen::VectorXd& positions_m) {
    positions_ = positions_m;
    gradient_ = model_.gradient_n(positions_);
    support_.clear();
    if (!(model_.is_linear() && factorised_)) {
        if (!factorise()) return false;
        responding_.clear();
        responses_.resize(positions_.size(), 0);
        factorised_ = true;
    }
    Eigen::VectorXd move = Eigen::VectorXd::Zero(positions_.size());
    for (Eigen::Index k = 0; k < move.size(); ++k)
        if (system_.is_prescribed()[static_cast<std::size_t>(k)]) move[k] = target_[k] - positions_[k];
    set_.take_planes(positions_);
    Eigen::VectorXd force = gradient_ + support_forces();
    if (!move.isZero(0)) force += model_.stiffness_times(positions_, move);
    alone_ = move - system_.solve(force);
    return alone_.allFinite();
}

void Iteration::respond_to_known() {
    known_.clear();
    std::vector<std::uint32_t> missing;
    for (Candidate& candidate : set_.candidates()) {
        if (!candidate.known) continue;
        known_.push_back(&candidate);
        if (std::find(responding_.begin(), responding_.end(), candidate.node) == responding_.end())
            missing.push_back(candidate.node);
    }
    if (missing.empty()) return;
    const Eigen::MatrixXd added = system_.unit_force_responses(missing);
    responses_.conservativeResize(Eigen::NoChange, responses_.cols() + added.cols());
    responses_.rightCols(added.cols()) = added;
    responding_.insert(responding_.end(), missing.begin(), missing.end());
}

LawProblem Iteration::law_problem() const {
    std::vector<Eigen::Index> column;
    for (const Candidate* candidate : known_)
        column.push_back(
            3 * (std::find(responding_.begin(), responding_.end(), candidate->node) - responding_.begin()));
    LawProblem problem;
    const auto size = 3 * static_cast<Eigen::Index>(known_.size());
    problem.compliance_m_per_n.resize(size, size);
    problem.offset_m.resize(size);
    for (std::size_t i = 0; i < known_.size(); ++i) {
        const Candidate& candidate = *known_[i];
        const Eigen::Index node = first_unknown(candidate.node);
        const auto row = 3 * static_cast<Eigen::Index>(i);
        const Eigen::Vector3d place = positions_.segment<3>(node) + alone_.segment<3>(node);
        problem.offset_m.segment<3>(row) = candidate.frame.transpose() * (place - candidate.anchor_m);
        problem.offset_m[row] = candidate.frame.col(0).dot(place - candidate.foot_m);
        problem.nodes.push_back(candidate.law);
        for (std::size_t j = 0; j < known_.size(); ++j)
            problem.compliance_m_per_n.block<3, 3>(row, 3 * static_cast<Eigen::Index>(j)) =
                candidate.frame.transpose() * responses_.block<3, 3>(node, column[j]) * known_[j]->frame;
    }
    return problem;
}

LawSolution Iteration::solve_once(ContactEffort& effort) const {
    const LawProblem problem = law_problem();
    Eigen::VectorXd start(problem.offset_m.size());
    std::vector<bool> touching;
    for (std::size_t i = 0; i < known_.size(); ++i) {
        start.segment<3>(3 * static_cast<Eigen::Index>(i)) =
            known_[i]->frame.transpose() * known_[i]->force_n;
        touching.push_back(known_[i]->touching);
    }
    LawSolution solution = solve_law(problem, start, touching);
    effort.law_iterations += solution.iterations;
    effort.law_fallbacks += solution.fallbacks;
    return solution;
}

/// A sticking node that would be pulled if it is held and go inside if it is let go slides for this step.
bool Iteration::let_slide(const std::vector<bool>& unsettled) {
    bool any = false;
    for (std::size_t i = 0; i < known_.size(); ++i) {
        Candidate& candidate = *known_[i];
        if (!unsettled[i] || !candidate.keeps_anchor || candidate.law.bilateral) continue;
        candidate.law.friction = 0;
        candidate.keeps_anchor = false;
        candidate.let_slide = true;
        any = true;
    }
    return any;
}

void Iteration::solve_known(ContactEffort& effort) {
    respond_to_known();
    LawSolution solution = solve_once(effort);
    while (!solution.converged && let_slide(solution.unsettled))
        solution = solve_once(effort);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(responses_.cols());
    for (std::size_t i = 0; i < known_.size(); ++i) {
        Candidate& candidate = *known_[i];
        candidate.touching = solution.touching[i];
        candidate.slipping = solution.slipping[i];
        candidate.force_n = candidate.frame * solution.force_n.segment<3>(3 * static_cast<Eigen::Index>(i));
        const auto at = std::find(responding_.begin(), responding_.end(), candidate.node);
        force.segment<3>(3 * (at - responding_.begin())) += candidate.force_n;
    }
    direction_ = alone_ + responses_ * force;
}

void Iteration::solve_laws(const ContactLimits& limits, double catch_tolerance_m, ContactEffort& effort) {
    for (int round = 0; round < limits.max_catch_rounds; ++round) {
        solve_known(effort);
        if (!direction_.allFinite()) fail_result("contact: the forces of contact are not finite");
        if (!set_.find_new(positions_ + direction_, catch_tolerance_m)) return;
    }
    fail_result(fmt::format("contact: still new touching nodes after {} rounds", limits.max_catch_rounds));
}

/// [3 nodes] what friction does where nodes slip: the part of the forces that follows from no potential.
Eigen::VectorXd Iteration::friction_forces() const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(positions_.size());
    for (const Candidate& candidate : set_.candidates()) {
        if (!candidate.touching || !candidate.slipping) continue;
        const Eigen::Vector3d normal = candidate.frame.col(0);
        result.segment<3>(first_unknown(candidate.node)) +=
            candidate.force_n - normal * normal.dot(candidate.force_n);
    }
    return result;
}

double Iteration::violation_m(const Eigen::VectorXd& positions_m) const {
    double sum = 0;
    for (const Candidate& candidate : set_.candidates())
        sum += set_.violation_m(candidate, positions_m);
    for (Eigen::Index k = 0; k < positions_m.size(); ++k)
        if (system_.is_prescribed()[static_cast<std::size_t>(k)])
            sum += std::abs(target_[k] - positions_m[k]);
    return sum;
}

/// Goes along the direction until the merit has fallen enough.
bool Iteration::advance(Eigen::VectorXd& positions_m) {
    const auto arrive = [&](Eigen::VectorXd& trial) {
        set_.put_on_surface(trial);
        for (Eigen::Index k = 0; k < trial.size(); ++k)
            if (system_.is_prescribed()[static_cast<std::size_t>(k)]) trial[k] = target_[k];
    };
    if (model_.is_linear()) {
        positions_m = positions_ + direction_;
        return true;
    }
    const Eigen::VectorXd friction = friction_forces();
    double largest_n = 0;
    for (const Candidate& candidate : set_.candidates())
        largest_n = std::max(largest_n, candidate.force_n.norm());
    const Eigen::VectorXd after = gradient_ + model_.stiffness_times(positions_, direction_);
    for (Eigen::Index k = 0; k < after.size(); ++k)
        if (system_.is_prescribed()[static_cast<std::size_t>(k)])
            largest_n = std::max(largest_n, std::abs(after[k]));
    const double penalty_n = kPenaltyMargin * largest_n;
    const auto merit = [&](const Eigen::VectorXd& x) {
        return model_.value_j(x) - friction.dot(x - positions_) + penalty_n * violation_m(x);
    };
    const double start_j = merit(positions_);
    const double slope_j = (gradient_ - friction).dot(direction_) - penalty_n * violation_m(positions_);
    const bool unseen = -slope_j <= std::max(kUnseenDecrease * std::abs(start_j), unseen_j_);
    for (double step = 1; step >= kSmallestStep; step /= 2) {
        Eigen::VectorXd trial = positions_ + step * direction_;
        if (step == 1) arrive(trial);
        const double value_j = merit(trial);
        if (!std::isfinite(value_j)) continue;
        if (unseen || value_j <= start_j + kSufficientDecrease * step * slope_j) {
            positions_m = trial;
            return true;
        }
    }
    return false;
}

double extent_m(const Eigen::VectorXd& rest_m) {
    const Eigen::Map<const Eigen::Matrix3Xd> points(rest_m.data(), 3, rest_m.size() / 3);
    return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
}

double gap_limit_m(const StepModel& model, const ContactLimits& limits) {
    return limits.relative_gap * extent_m(model.objective().body->rest_positions_m());
}

/// What the rounding of the forces does along the smallest way that counts.
double unseen_j(const StepModel& model, const ContactLimits& limits) {
    return model.objective().rounding_noise_n() * gap_limit_m(model, limits);
}

[[noreturn]] void give_up(const char* why, const ContactEffort& effort, const ContactCheck& check) {
    fail_result(fmt::format(
        "no state in contact found, {}: {} iterations; residual {:.3g} N where {:.3g} N is wanted, {:.3g} m "
        "deep and {:.3g} m off the surface where {:.3g} m is, a pull of {:.3g} N (is the object held?)",
        why, effort.newton_iterations, check.residual_n, check.residual_limit_n, check.deepest_m,
        check.widest_touch_m, check.gap_limit_m, check.strongest_pull_n));
}

}  // namespace

bool is_met(const ContactCheck& check) {
    return check.residual_n <= check.residual_limit_n && check.deepest_m <= check.gap_limit_m &&
           check.widest_touch_m <= check.gap_limit_m && check.strongest_pull_n <= check.residual_limit_n &&
           check.cone_excess_n <= check.residual_limit_n;
}

ContactCheck check_contact(const StepModel& model, const std::vector<bool>& is_prescribed,
                           const Eigen::VectorXd& target_m, const ContactSet& set,
                           const Eigen::VectorXd& positions_m, const ContactLimits& limits) {
    ContactCheck check;
    const Objective& objective = model.objective();
    check.gap_limit_m = gap_limit_m(model, limits);
    const Eigen::VectorXd gradient = model.gradient_n(positions_m);
    Eigen::VectorXd left = gradient;
    for (Eigen::Index k = 0; k < left.size(); ++k) {
        if (!is_prescribed[static_cast<std::size_t>(k)]) continue;
        left[k] = 0;
        check.widest_touch_m = std::max(check.widest_touch_m, std::abs(positions_m[k] - target_m[k]));
    }
    for (const Candidate& candidate : set.candidates()) {
        const Eigen::Index node = first_unknown(candidate.node);
        const Eigen::Vector3d place = positions_m.segment<3>(node);
        if (!candidate.touching) {
            check.deepest_m = std::max(check.deepest_m, set.violation_m(candidate, positions_m));
            continue;
        }
        const Eigen::Vector3d force = candidate.frame.transpose() * gradient.segment<3>(node);
        Eigen::Vector3d off = candidate.frame.transpose() * (place - candidate.anchor_m);
        off[0] = candidate.frame.col(0).dot(place - candidate.foot_m);
        const bool slides = candidate.law.friction == 0 || candidate.slipping;
        check.widest_touch_m = std::max(check.widest_touch_m, slides ? std::abs(off[0]) : off.norm());
        check.complementarity_j = std::max(check.complementarity_j, std::abs(off[0] * force[0]));
        Eigen::Vector2d wrong = Eigen::Vector2d::Zero();
        if (!candidate.law.bilateral) check.strongest_pull_n = std::max(check.strongest_pull_n, -force[0]);
        if (!candidate.keeps_anchor) {
            const double radius = candidate.law.friction * std::max(force[0], 0.0);
            check.cone_excess_n = std::max(check.cone_excess_n, force.tail<2>().norm() - radius);
            const double slip_m = off.tail<2>().norm();
            if (slides && slip_m > check.gap_limit_m) {
                wrong = force.tail<2>() + radius * off.tail<2>() / slip_m;
            } else if (slides && radius == 0) {
                wrong = force.tail<2>();
            }
            check.slip_error_n = std::max(check.slip_error_n, wrong.norm());
        }
        left.segment<3>(node) = candidate.frame.rightCols<2>() * wrong;
    }
    check.residual_n = left.norm();
    check.force_scale_n = (gradient - left).norm();
    if (objective.weight_n_per_m.size() > 0)
        check.force_scale_n =
            std::max(check.force_scale_n,
                     objective.weight_n_per_m.cwiseProduct(positions_m - objective.anchor_m).norm());
    check.residual_limit_n =
        std::max(limits.relative_residual * check.force_scale_n, objective.rounding_noise_n());
    return check;
}

ContactEffort solve_contact(StepModel& model, FreeSystem& system, const Eigen::VectorXd& target_m,
                            const ContactLimits& limits, ContactSet& set, Eigen::VectorXd& positions_m,
                            ContactCheck& check) {
    ContactEffort effort;
    Iteration iteration(model, system, target_m, set, unseen_j(model, limits));
    const double catch_tolerance_m = kCatchTolerance * gap_limit_m(model, limits);
    while (effort.newton_iterations < limits.max_iterations) {
        ++effort.newton_iterations;
        if (!iteration.prepare(positions_m)) give_up("the system is singular", effort, check);
        iteration.solve_laws(limits, catch_tolerance_m, effort);
        if (!iteration.advance(positions_m)) give_up("the line search ended", effort, check);
        set.take_planes(positions_m);
        check = check_contact(model, system.is_prescribed(), target_m, set, positions_m, limits);
        if (is_met(check)) return effort;
    }
    give_up("too many iterations", effort, check);
}

}  // namespace knead::tools
