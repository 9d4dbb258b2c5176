// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/static_answer.h"

#include <cstring>
#include <limits>

#include "common/error.h"
#include "evaluate/bytes.h"
#include "knead/formats/hash.h"

namespace knead::tools {
namespace {

void measure_displacement(const std::vector<Point>& positions_m, const TetMesh& mesh, StaticAnswer& answer) {
    answer.displacement_m = positions_m;
    for (std::size_t n = 0; n < mesh.nodes_m.size(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            answer.displacement_m[n][axis] -= mesh.nodes_m[n][axis];
}

/// With tensors the iteration converges linearly, and slowly where much turns: more of it, and a residual
/// that leaves the force good to eight digits.
NewtonLimits limits_with_tensors() {
    NewtonLimits limits;
    limits.max_iterations = 500;
    limits.relative_residual = 1e-8;
    return limits;
}

StaticAnswer solve_prescribed(const TetMesh& mesh, StaticProblem problem, const MeshLoad& load,
                              const NewtonLimits& limits = {}) {
    StaticAnswer answer;
    const StaticSolution solution = problem.solve(load.applied.motion, {}, limits);
    answer.force_n = felt_force_n(load.applied, solution);
    answer.linear_solves = solution.iterations;
    measure_displacement(solution.positions_m, mesh, answer);
    return answer;
}

/// The tool starts where it stands and goes down in a few parts, so that nodes are caught in their order.
StaticAnswer solve_contact(const TetMesh& mesh, const Material& material, const MeshLoad& load) {
    constexpr int kParts = 8;
    StaticAnswer answer;
    ContactProblem problem(mesh, material);
    ContactTool tool = contact_tool(load.press->tool, mesh.nodes_m);
    const RigidPose end = load.press->pose_at_end();
    const RigidPose start = tool.pose;
    ContactSolution solution;
    for (int part = 1; part <= kParts; ++part) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            tool.pose.position_m[axis] =
                start.position_m[axis] +
                (end.position_m[axis] - start.position_m[axis]) * part / static_cast<double>(kParts);
        solution = problem.equilibrium(load.applied.motion, {tool}, solution.state.positions_m);
        tool.before = solution.tools[0].touches;
        answer.linear_solves += solution.newton_iterations;
    }
    const Point& force_n = solution.tools[0].force_n;
    for (std::size_t axis = 0; axis < 3; ++axis)
        answer.force_n -= force_n[axis] * load.press->direction[axis];
    measure_displacement(solution.state.positions_m, mesh, answer);
    return answer;
}

}  // namespace

std::string MeshLoad::fingerprint() const {
    std::string bytes = name + '\n';
    append_bytes(bytes, applied.motion.nodes);
    append_bytes(bytes, applied.motion.displacement_m);
    append_bytes(bytes, applied.work_directions);
    for (const TiedNode& tie : applied.motion.ties) {
        append_bytes(bytes, std::vector{tie.node});
        append_bytes(bytes, std::vector{tie.displacement_m});
        for (const auto& [node, weight] : tie.masters)
            append_bytes(bytes, std::vector{static_cast<double>(node), weight});
    }
    if (press) {
        const ToolSet& tool = press->tool;
        append_bytes(bytes, tool.nodes);
        append_bytes(bytes, std::vector{tool.rest_position_m, press->direction});
        append_bytes(bytes, std::vector{tool.rest_orientation_wxyz});
        append_bytes(bytes,
                     std::vector<double>{static_cast<double>(tool.shape), static_cast<double>(tool.contact),
                                         tool.radius_m, tool.half_length_m, tool.friction_coefficient,
                                         tool.half_extents_m[0], tool.half_extents_m[1], press->way_m});
    }
    return sha256_of(bytes);
}

StaticAnswer solve(const TetMesh& mesh, const Material& material, const MeshLoad& load,
                   const std::vector<ElasticityTensor>& tensors) {
    try {
        if (load.in_contact() && !tensors.empty())
            fail_result("a tool that touches and leaves is not solved with elasticity tensors");
        StaticAnswer answer;
        if (load.in_contact())
            answer = solve_contact(mesh, material, load);
        else if (tensors.empty())
            answer = solve_prescribed(mesh, StaticProblem(mesh, material), load);
        else
            answer =
                solve_prescribed(mesh, StaticProblem(mesh, material, tensors), load, limits_with_tensors());
        answer.converged = true;
        return answer;
    } catch (const ToolError& error) {
        if (error.code() != ExitCode::no_valid_result) throw;
        StaticAnswer answer;
        answer.problem = error.what();
        return answer;
    }
}

std::string to_bytes(const StaticAnswer& answer) {
    std::string bytes;
    append_bytes(bytes, std::vector<double>{answer.converged ? 1.0 : 0.0, answer.force_n,
                                            static_cast<double>(answer.linear_solves),
                                            static_cast<double>(answer.displacement_m.size())});
    append_bytes(bytes, answer.displacement_m);
    return bytes + answer.problem;
}

std::optional<StaticAnswer> answer_of(const std::string& bytes) {
    double head[4];
    if (bytes.size() < sizeof head) return std::nullopt;
    std::memcpy(head, bytes.data(), sizeof head);
    const auto most = static_cast<double>((bytes.size() - sizeof head) / sizeof(Point));
    if (!(head[2] >= 0 && head[2] <= std::numeric_limits<int>::max()) || !(head[3] >= 0 && head[3] <= most))
        return std::nullopt;
    StaticAnswer answer;
    answer.converged = head[0] != 0;
    answer.force_n = head[1];
    answer.linear_solves = static_cast<int>(head[2]);
    const auto nodes = static_cast<std::size_t>(head[3]);
    answer.displacement_m.resize(nodes);
    if (nodes > 0)
        std::memcpy(answer.displacement_m.data(), bytes.data() + sizeof head, nodes * sizeof(Point));
    answer.problem = bytes.substr(sizeof head + nodes * sizeof(Point));
    return answer;
}

}  // namespace knead::tools
