// SPDX-License-Identifier: Apache-2.0
#include "stability/contact_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "reference/tool_surface.h"
#include "support/simulation_of.h"

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

/// Where the steps of a trajectory are linearised: how far each ends beyond where velocities alone lead, and
/// the share of it that the next one is expected to repeat: none when it was more than 5e-4 of the mean edge
/// (root mean square over the free nodes).
class LinearisationPoint {
  public:
    explicit LinearisationPoint(const Asset& asset) {
        double volume_m3 = 0;
        for (const Tetrahedron& t : asset.tetrahedra) {
            const auto edge = [&](std::size_t k) {
                const Point &a = asset.nodes_m[t[0]], &b = asset.nodes_m[t[k]];
                return Point{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
            };
            const Point a = edge(1), b = edge(2), c = edge(3);
            volume_m3 += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                          a[2] * (b[0] * c[1] - b[1] * c[0])) /
                         6;
        }
        const double mean_m3 = volume_m3 / static_cast<double>(asset.tetrahedra.size());
        const double small_m = 5e-4 * std::cbrt(6 * std::sqrt(2.0) * mean_m3);
        most_squared_m2_ = small_m * small_m * asset.free_node_count;
    }
    [[nodiscard]] std::vector<Point> ahead(const tools::MotionState& from, double dt_s) const {
        std::vector<Point> point = from.positions_m;
        for (std::size_t n = 0; n < point.size(); ++n)
            for (std::size_t k = 0; k < 3; ++k)
                point[n][k] +=
                    dt_s * from.velocities_m_per_s[n][k] + (beyond_m_.empty() ? 0 : share_ * beyond_m_[n][k]);
        return point;
    }
    void follow(const tools::MotionState& from, const tools::MotionState& to, double dt_s) {
        std::vector<Point> now = to.positions_m;
        double expected = 0, agreed = 0, squared_m2 = 0;
        for (std::size_t n = 0; n < now.size(); ++n) {
            for (std::size_t k = 0; k < 3; ++k) {
                now[n][k] -= from.positions_m[n][k] + dt_s * from.velocities_m_per_s[n][k];
                squared_m2 += now[n][k] * now[n][k];
                if (beyond_m_.empty()) continue;
                expected += beyond_m_[n][k] * beyond_m_[n][k];
                agreed += beyond_m_[n][k] * now[n][k];
            }
        }
        share_ = expected > 0 && squared_m2 <= most_squared_m2_ ? std::clamp(agreed / expected, 0.0, 1.0) : 0;
        beyond_m_ = std::move(now);
    }

  private:
    std::vector<Point> beyond_m_;
    double share_ = 0;
    double most_squared_m2_ = 0;
};

}  // namespace

Record run_runtime(const ContactScene& scene, const Motion& motion, double dt_s, int steps,
                   SimulationConfig config) {
    config.tools.clear();
    for (std::size_t t = 0; t < scene.asset.tools.size(); ++t)
        config.tools.push_back(t);
    config.with_torque = true;
    Simulation simulation = simulation_of(scene.asset, config);
    Record run;
    const std::vector<Pose> rest = rest_poses(scene.asset);
    Eigen::Matrix3Xd velocities(3, static_cast<Eigen::Index>(simulation.node_count()));
    for (int k = 1; k <= steps; ++k) {
        const std::vector<Pose> poses = motion(rest, k * dt_s);
        run.status |= simulation.step(poses.data(), dt_s).status;
        simulation.velocities_m_per_s(velocities.data());
        run.speed_m_per_s.push_back(velocities.colwise().norm().maxCoeff());
        run.steps.emplace_back();
        for (std::size_t t = 0; t < poses.size(); ++t) {
            const ToolResult& result = simulation.tool(t);
            run.steps.back().push_back({vec(result.force_n), vec(result.torque_nm),
                                        touched(scene.asset.tools[t], poses[t], simulation.positions_m(),
                                                result.touched_nodes, run.farthest_touch_m)});
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
    std::vector<Point> where_m;
    tools::ContactLimits limits;
    limits.relative_residual = kResidual;
    Record run;
    LinearisationPoint point(scene.asset);
    for (int k = 1; k <= steps; ++k) {
        const std::vector<Pose> poses = motion(rest, k * dt_s);
        for (std::size_t t = 0; t < tools.size(); ++t) {
            tools[t].pose_before = tools[t].pose;
            tools[t].pose = {poses[t].position_m, poses[t].orientation_wxyz};
        }
        if (oracle == Oracle::linearised) where_m = point.ahead(state, dt_s);
        const tools::ContactSolution solution =
            oracle == Oracle::converged
                ? problem.step(state, scene.held, tools, dt_s, limits)
                : problem.linearised_step(state, scene.held, tools, dt_s, where_m, limits);
        point.follow(state, solution.state, dt_s);
        state = solution.state;
        if (solution.let_slide > 0 && run.slid_at == 0) run.slid_at = k;
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

Difference difference(const Record& run, const Record& truth, std::size_t tool, int until) {
    Difference d;
    const int end = until > 0 ? until - 1 : static_cast<int>(truth.steps.size());
    int apart = 0;
    int same_for = 0;
    for (int k = 0; k < end; ++k) {
        const ToolSample& a = run.steps[static_cast<std::size_t>(k)][tool];
        const ToolSample& b = truth.steps[static_cast<std::size_t>(k)][tool];
        d.largest_force_n = std::max(d.largest_force_n, b.force_n.norm());
        std::vector<std::uint32_t> odd;
        std::set_symmetric_difference(a.touched.begin(), a.touched.end(), b.touched.begin(), b.touched.end(),
                                      std::back_inserter(odd));
        d.touching_steps += a.touched.empty() && b.touched.empty() ? 0 : 1;
        d.most_apart = std::max(d.most_apart, odd.size());
        apart = odd.empty() ? 0 : apart + 1;
        d.steps_apart += odd.empty() ? 0 : 1;
        d.longest_apart = std::max(d.longest_apart, apart);
        const bool as_before =
            k > 0 && odd.empty() && b.touched == truth.steps[static_cast<std::size_t>(k) - 1][tool].touched;
        same_for = as_before ? same_for + 1 : 0;
        const double force = (a.force_n - b.force_n).norm();
        const double torque = (a.torque_n_m - b.torque_n_m).norm();
        if (force > d.force) d.worst_step = k + 1;
        d.force = std::max(d.force, force);
        d.torque = std::max(d.torque, torque);
        if (same_for < kSettledSteps) continue;
        d.settled_force = std::max(d.settled_force, force);
        d.settled_torque = std::max(d.settled_torque, torque);
    }
    if (d.largest_force_n == 0) return d;
    d.force /= d.largest_force_n;
    d.settled_force /= d.largest_force_n;
    d.torque /= d.largest_force_n * kCubeSideM / 2;
    d.settled_torque /= d.largest_force_n * kCubeSideM / 2;
    return d;
}

std::string text(const Difference& d) {
    return fmt::format(
        "{:.3f} N; force {:.1e} (step {}), settled {:.1e}; torque {:.1e}, settled {:.1e}; sets differ in {} "
        "of "
        "{} steps, {} in a row, by {} nodes",
        d.largest_force_n, d.force, d.worst_step, d.settled_force, d.torque, d.settled_torque, d.steps_apart,
        d.touching_steps, d.longest_apart, d.most_apart);
}

}  // namespace knead::test
