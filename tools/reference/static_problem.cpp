// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/static_problem.h"

#include <fmt/format.h>

#include <cmath>

#include "common/error.h"
#include "reference/load_steps.h"
#include "reference/prescribed_unknowns.h"

namespace knead::tools {

struct StaticProblem::Impl {
    ElasticBody body;
    KeptSystem system;
};

StaticProblem::StaticProblem(const TetMesh& mesh, const Material& material)
    : impl_(std::make_unique<Impl>(Impl{ElasticBody(mesh, material), {}})) {}
StaticProblem::StaticProblem(const TetMesh& mesh, const Material& material,
                             const std::vector<ElasticityTensor>& tensors)
    : impl_(std::make_unique<Impl>(Impl{ElasticBody(mesh, material, tensors), {}})) {}
StaticProblem::StaticProblem(StaticProblem&&) noexcept = default;
StaticProblem& StaticProblem::operator=(StaticProblem&&) noexcept = default;
StaticProblem::~StaticProblem() = default;

StaticSolution StaticProblem::solve(const PrescribedMotion& prescribed, const std::vector<Point>& start_m,
                                    const NewtonLimits& limits) {
    const ElasticBody& body = impl_->body;
    const PrescribedUnknowns unknowns = spread_with_ties(prescribed, body.rest_positions_m());
    Eigen::VectorXd positions = start_m.empty() ? body.rest_positions_m()
                                                : to_unknowns(start_m, body.node_count(), "start positions");
    Objective objective;
    objective.body = &body;
    return equilibrium(objective, impl_->system.of(body, unknowns.is_prescribed, unknowns.ties), prescribed,
                       unknowns.target_m, limits, positions);
}

StaticSolution StaticProblem::solve_linear(const PrescribedMotion& prescribed) {
    const ElasticBody& body = impl_->body;
    const PrescribedUnknowns unknowns = spread_with_ties(prescribed, body.rest_positions_m());
    FreeSystem& system = impl_->system.of(body, unknowns.is_prescribed, unknowns.ties);
    Objective objective;
    objective.body = &body;

    Eigen::VectorXd positions = body.rest_positions_m();
    if (!follow_prescribed(objective, system, unknowns.target_m, positions))
        fail_result(
            fmt::format("the stiffness matrix is singular: {} free unknowns, {} nodes prescribed (too few "
                        "to hold the object?)",
                        system.unknown_count(), prescribed.nodes.size()));
    const Eigen::VectorXd displacement = positions - body.rest_positions_m();
    const Eigen::VectorXd holding =
        stiffness_times(body, body.rest_positions_m(), Curvature::exact, displacement);
    StaticSolution solution;
    solution.positions_m = to_points(positions);
    solution.reactions_n = reactions(prescribed, holding);
    solution.tied_reactions_n = tied_reactions(prescribed, holding);
    solution.energy_j = displacement.dot(holding) / 2;
    solution.iterations = 1;
    const Eigen::VectorXd reduced = system.reduced(holding);
    for (Eigen::Index k = 0; k < holding.size(); ++k) {
        const bool is_prescribed = unknowns.is_prescribed[static_cast<std::size_t>(k)];
        double& norm = is_prescribed ? solution.force_scale_n : solution.residual_n;
        norm = std::hypot(norm, reduced[k]);
    }
    return solution;
}

}  // namespace knead::tools
