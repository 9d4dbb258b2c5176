// SPDX-License-Identifier: Apache-2.0
#include "stability/contact_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include "reference/tool_surface.h"

namespace knead::test {
namespace {

/// Of the reference's steps, relative to the forces: a body that has almost come to rest has small ones.
constexpr double kResidual = 1e-8;

std::vector<Pose> rest_poses(const Asset& asset) {
    std::vector<Pose> poses;
    for (const ToolSet& tool : asset.tools)
        poses.push_back({tool.rest_position_m, tool.rest_orientation_wxyz});
    return poses;
}

tools::ContactTool placed(const ToolSet& tool, const Pose& pose) {
    tools::ContactTool result;
    result.shape = tool.shape;
    result.radius_m = tool.radius_m;
    result.half_length_m = tool.half_length_m;
    result.half_extents_m = tool.half_extents_m;
    result.pose = {pose.position_m, pose.orientation_wxyz};
    return result;
}

/// Distance of each of the tool's nodes from its surface, negative inside. @param positions_m [nodes][3]
std::vector<double> gaps_m(const ToolSet& tool, const Pose& pose, const double* positions_m) {
    const tools::ToolSurface surface(placed(tool, pose));
    std::vector<double> gaps;
    for (const std::uint32_t n : tool.nodes) {
        const Eigen::Map<const Eigen::Vector3d> position(positions_m + std::size_t{3} * n);
        gaps.push_back(surface.nearest(surface.to_local(position)).gap_m);
    }
    return gaps;
}

/// The nodes that the runtime holds, of which it tells the count: those closest to the surface.
std::vector<std::uint32_t> touched(const ToolSet& tool, const Pose& pose, const double* positions_m,
                                   std::size_t count, double& farthest_m) {
    if (count == 0) return {};
    const std::vector<double> gaps = gaps_m(tool, pose, positions_m);
    std::vector<std::size_t> order(gaps.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return std::abs(gaps[a]) < std::abs(gaps[b]); });
    std::vector<std::uint32_t> nodes;
    for (std::size_t i = 0; i < std::min(count, order.size()); ++i) {
        nodes.push_back(tool.nodes[order[i]]);
        farthest_m = std::max(farthest_m, std::abs(gaps[order[i]]));
    }
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

bool in_any(const Asset& asset, const std::vector<Pose>& poses) {
    for (std::size_t t = 0; t < poses.size(); ++t)
        for (const double gap_m : gaps_m(asset.tools[t], poses[t], asset.nodes_m[0].data()))
            if (gap_m < 0) return true;
    return false;
}

}  // namespace

Record run_runtime(const ContactScene& scene, const Motion& motion, double dt_s, int steps,
                SimulationConfig config) {
    config.tools.clear();
    for (std::size_t t = 0; t < scene.asset.tools.size(); ++t)
        config.tools.push_back(t);
    config.with_torque = true;
    if (getenv("KP")) {config.arithmetic = Arithmetic::float64; config.force_tolerance=1e-8;config.max_contact_passes=1000;}
    Result<Simulation> created = Simulation::create(scene.asset, config);
    Record run;
    if (!created.ok()) throw std::runtime_error(created.error().text());
    Simulation simulation = std::move(created).value();
    const std::vector<Pose> rest = rest_poses(scene.asset);
    for (int k = 1; k <= steps; ++k) {
        const std::vector<Pose> poses = motion(rest, k * dt_s);
        run.status.push_back(simulation.step(poses.data(), dt_s).status);
        run.steps.emplace_back();
        for (std::size_t t = 0; t < poses.size(); ++t) {
            const ToolResult& result = simulation.tool(t);
            run.steps.back().push_back(
                {vec(result.force_n), vec(result.torque_nm),
                 touched(scene.asset.tools[t], poses[t], simulation.positions_m(), result.touched_nodes,
                         run.farthest_touch_m)});
        }
    }
    return run;
}

Record run_reference(const ContactScene& scene, const Motion& motion, double dt_s, int steps, Oracle oracle) {
    tools::ContactProblem problem(scene.mesh, scene.material);
    std::vector<tools::ContactTool> tools;
    for (const ToolSet& tool : scene.asset.tools) {
        tools.push_back(tools::contact_tool(tool, scene.asset.nodes_m));
        tools.back().catch_place = tools::CatchPlace::solved_without_it;  // as the runtime
    }
    const std::vector<Pose> rest = rest_poses(scene.asset);
    tools::MotionState state = problem.rest();
    tools::LinearisedAt where_velocity_leads;
    where_velocity_leads.stuck_at_target = false;  // as the runtime
    tools::ContactLimits limits;
    limits.relative_residual = kResidual;
    Record run;
    bool at_rest = true;
    for (int k = 1; k <= steps; ++k) {
        const std::vector<Pose> poses = motion(rest, k * dt_s);
        at_rest = at_rest && !in_any(scene.asset, poses);
        if (at_rest) {  // nothing for the reference to be relative to
            run.steps.emplace_back(tools.size());
            continue;
        }
        for (std::size_t t = 0; t < tools.size(); ++t) {
            tools[t].pose_before = tools[t].pose;
            tools[t].pose = {poses[t].position_m, poses[t].orientation_wxyz};
        }
        const tools::ContactSolution solution =
            oracle == Oracle::converged
                ? problem.step(state, scene.held, tools, dt_s, limits)
                : problem.linearised_step(state, scene.held, tools, dt_s, where_velocity_leads, limits);
        state = solution.state;
        run.let_slide += solution.let_slide;
        run.steps.emplace_back();
        for (std::size_t t = 0; t < tools.size(); ++t) {
            const tools::ToolReaction& reaction = solution.tools[t];
            tools[t].before = reaction.touches;
            ToolSample sample{vec(reaction.force_n), vec(reaction.torque_n_m), {}};
            for (std::size_t i = 0; i < tools[t].nodes.size(); ++i) {
                const tools::TouchMode mode = reaction.touches[i].mode;
                if (mode == tools::TouchMode::sticking || mode == tools::TouchMode::sliding)
                    sample.touched.push_back(tools[t].nodes[i]);
            }
            run.steps.back().push_back(std::move(sample));
        }
    }
    return run;
}

Difference difference(const Record& run, const Record& truth, std::size_t tool) {
    Difference d;
    double largest_torque = 0, torque_error = 0;
    double force = 0, same = 0, since = 0;
    int apart = 0;
    for (std::size_t k = 0; k < truth.steps.size(); ++k) {
        const ToolSample& a = run.steps[k][tool];
        const ToolSample& b = truth.steps[k][tool];
        d.largest_force_n = std::max(d.largest_force_n, b.force_n.norm());
        largest_torque = std::max(largest_torque, b.torque_n_m.norm());
        torque_error = std::max(torque_error, (a.torque_n_m - b.torque_n_m).norm());
        std::vector<std::uint32_t> odd;
        std::set_symmetric_difference(a.touched.begin(), a.touched.end(), b.touched.begin(),
                                      b.touched.end(), std::back_inserter(odd));
        d.touching_steps += a.touched.empty() && b.touched.empty() ? 0 : 1;
        d.most_apart = std::max(d.most_apart, odd.size());
        apart = odd.empty() ? 0 : apart + 1;
        d.steps_apart += odd.empty() ? 0 : 1;
        d.longest_apart = std::max(d.longest_apart, apart);
        const double error = (a.force_n - b.force_n).norm();
        if (error > force) d.worst_step = static_cast<int>(k) + 1;
        force = std::max(force, error);
        if (odd.empty()) same = std::max(same, error);
        if (d.steps_apart == 0) since = std::max(since, error);
    }
    if (d.largest_force_n > 0) {
        d.force = force / d.largest_force_n;
        d.force_while_same = same / d.largest_force_n;
        d.force_since_same = since / d.largest_force_n;
    }
    if (largest_torque > 0) d.torque = torque_error / largest_torque;
    return d;
}

std::string text(const Difference& d) {
    return fmt::format(
        "largest force {:.3f} N; force error {:.1e} (step {}), same sets {:.1e}, before sets first differ "
        "{:.1e}; torque error {:.1e}; sets differ in {} of {} steps, {} in a row, by {} nodes",
        d.largest_force_n, d.force, d.worst_step, d.force_while_same, d.force_since_same, d.torque,
        d.steps_apart, d.touching_steps, d.longest_apart, d.most_apart);
}

}  // namespace knead::test
