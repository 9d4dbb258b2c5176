// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/contact_problem.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "common/error.h"
#include "reference/contact_newton.h"
#include "reference/contact_set.h"
#include "reference/moving_body.h"
#include "reference/prescribed_unknowns.h"
#include "reference/step_model.h"

namespace knead::tools {

struct ContactProblem::Impl {
    MovingBody body;

    ContactSolution solve(StepModel& model, const PrescribedMotion& held, const PrescribedUnknowns& unknowns,
                          const std::vector<ContactTool>& tools, ContactSet& set, const ContactLimits& limits,
                          Eigen::VectorXd& positions);
};

namespace {

Point to_point(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

void check_limits(const ContactLimits& limits) {
    if (!(limits.relative_residual > 0) || !(limits.relative_gap > 0) || limits.max_iterations < 1 ||
        limits.max_catch_rounds < 1)
        fail_input("contact limits: all of them must be positive");
}

ToolReaction reaction_of(std::size_t tool, std::size_t node_count, const ContactSet& set,
                         const Eigen::VectorXd& gradient_n, const Eigen::VectorXd& positions_m) {
    ToolReaction reaction;
    reaction.touches.resize(node_count);
    reaction.forces_n.assign(node_count, Point{0, 0, 0});
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();
    for (const Candidate& candidate : set.candidates()) {
        if (candidate.tool != tool) continue;
        reaction.touches[candidate.slot] = set.touch(candidate, positions_m);
        if (!candidate.touching) continue;
        const Eigen::Index node = first_unknown(candidate.node);
        const Eigen::Vector3d pushes = -gradient_n.segment<3>(node);
        const Eigen::Vector3d arm = positions_m.segment<3>(node) - set.surfaces()[tool].origin_m();
        reaction.forces_n[candidate.slot] = to_point(pushes);
        force += pushes;
        torque += arm.cross(pushes);
    }
    reaction.force_n = to_point(force);
    reaction.torque_n_m = to_point(torque);
    return reaction;
}

}  // namespace

ContactSolution ContactProblem::Impl::solve(StepModel& model, const PrescribedMotion& held,
                                            const PrescribedUnknowns& unknowns,
                                            const std::vector<ContactTool>& tools, ContactSet& set,
                                            const ContactLimits& limits, Eigen::VectorXd& positions) {
    ContactSolution solution;
    FreeSystem& free_system = body.system_for(unknowns.is_prescribed);
    const ContactEffort effort =
        solve_contact(model, free_system, unknowns.target_m, limits, set, positions, solution.check);
    const Eigen::VectorXd gradient = model.gradient_n(positions);
    for (std::size_t tool = 0; tool < tools.size(); ++tool)
        solution.tools.push_back(reaction_of(tool, tools[tool].nodes.size(), set, gradient, positions));
    for (const Candidate& candidate : set.candidates()) {
        solution.touching += candidate.touching ? 1 : 0;
        solution.let_slide += candidate.touching && candidate.let_slide ? 1 : 0;
    }
    solution.held_reactions_n = reactions(held, gradient);
    solution.energy_j = model.elastic_j(positions);
    solution.newton_iterations = effort.newton_iterations;
    solution.law_iterations = effort.law_iterations;
    solution.law_fallbacks = effort.law_fallbacks;
    return solution;
}

ContactTool contact_tool(const ToolSet& set, const std::vector<Point>& rest_m) {
    ContactTool tool;
    tool.shape = set.shape;
    tool.law = set.contact;
    tool.radius_m = set.radius_m;
    tool.half_length_m = set.half_length_m;
    tool.half_extents_m = set.half_extents_m;
    tool.friction_coefficient = set.friction_coefficient;
    tool.pose = tool.pose_before = {set.rest_position_m, set.rest_orientation_wxyz};
    tool.nodes = set.nodes;
    tool.before.resize(set.nodes.size());
    const Eigen::Vector3d origin(set.rest_position_m.data());
    const auto& q = set.rest_orientation_wxyz;
    const Eigen::Quaterniond turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
    const bool bonded = set.contact == ToolContact::bonded;
    std::optional<ToolSurface> surface;
    if (!bonded) surface.emplace(tool);
    for (std::size_t k = 0; k < set.nodes.size(); ++k) {
        if (set.nodes[k] >= rest_m.size())
            fail_input(
                fmt::format("contact tool: node {} of {} does not exist", set.nodes[k], rest_m.size()));
        const Eigen::Vector3d local =
            turn.conjugate() * (Eigen::Vector3d(rest_m[set.nodes[k]].data()) - origin);
        if (bonded) {
            tool.before[k] = {TouchMode::sticking, to_point(local)};
        } else if (surface->beside(local) && surface->nearest(local).gap_m < 0) {
            tool.before[k].mode = TouchMode::beside;
        }
    }
    return tool;
}

ContactProblem::ContactProblem(const TetMesh& mesh, const Material& material, const BodyForces& forces)
    : impl_(new Impl{{mesh, material, forces}}) {}
ContactProblem::ContactProblem(ContactProblem&&) noexcept = default;
ContactProblem& ContactProblem::operator=(ContactProblem&&) noexcept = default;
ContactProblem::~ContactProblem() = default;

MotionState ContactProblem::rest() const {
    return impl_->body.rest();
}

ContactSolution ContactProblem::equilibrium(const PrescribedMotion& held,
                                            const std::vector<ContactTool>& tools,
                                            const std::vector<Point>& start_m, const ContactLimits& limits) {
    check_limits(limits);
    const ElasticBody& body = impl_->body.elastic();
    const PrescribedUnknowns unknowns = spread(held, body.rest_positions_m());
    Eigen::VectorXd positions = start_m.empty() ? body.rest_positions_m()
                                                : to_unknowns(start_m, body.node_count(), "start positions");
    Objective objective;
    objective.body = &body;
    StepModel model(objective, impl_->body.weight_n(), std::nullopt);
    ContactSet set(tools, unknowns.is_prescribed, positions, positions, false);
    ContactSolution solution = impl_->solve(model, held, unknowns, tools, set, limits, positions);
    solution.state = {to_points(positions), std::vector<Point>(body.node_count(), Point{0, 0, 0})};
    return solution;
}

ContactSolution ContactProblem::step(const MotionState& from, const PrescribedMotion& held,
                                     const std::vector<ContactTool>& tools, double dt_s,
                                     const ContactLimits& limits) {
    check_limits(limits);
    const PosedStep step = impl_->body.step_from(from, dt_s);
    const PrescribedUnknowns unknowns = spread(held, impl_->body.elastic().rest_positions_m());
    StepModel model(step.objective, {}, std::nullopt);
    ContactSet set(tools, unknowns.is_prescribed, step.start_m, step.ahead_m(), false);
    Eigen::VectorXd positions = step.start_m;
    ContactSolution solution = impl_->solve(model, held, unknowns, tools, set, limits, positions);
    solution.state = step.end(positions);
    return solution;
}

ContactSolution ContactProblem::linearised_step(const MotionState& from, const PrescribedMotion& held,
                                                const std::vector<ContactTool>& tools, double dt_s,
                                                const std::vector<Point>& at_m, const ContactLimits& limits) {
    check_limits(limits);
    const PosedStep step = impl_->body.step_from(from, dt_s);
    const PrescribedUnknowns unknowns = spread(held, impl_->body.elastic().rest_positions_m());
    ContactSet set(tools, unknowns.is_prescribed, step.start_m, step.ahead_m(), true);
    Eigen::VectorXd point = step.ahead_m();
    for (Eigen::Index k = 0; k < point.size(); ++k)
        if (unknowns.is_prescribed[static_cast<std::size_t>(k)]) point[k] = unknowns.target_m[k];
    if (!at_m.empty()) point = to_unknowns(at_m, impl_->body.elastic().node_count(), "linearisation point");
    StepModel model(step.objective, {}, point);
    Eigen::VectorXd positions = point;
    ContactSolution solution = impl_->solve(model, held, unknowns, tools, set, limits, positions);
    solution.state = step.end(positions);
    return solution;
}

}  // namespace knead::tools
