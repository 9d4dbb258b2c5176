// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability/meters.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "reference/tool_surface.h"
#include "stability/criteria.h"

namespace knead::tools::stability {
namespace {

Eigen::Vector3d vec(const std::array<double, 3>& v) {
    return {v[0], v[1], v[2]};
}

Eigen::Quaterniond turn(const Pose& pose) {
    const auto& q = pose.orientation_wxyz;
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

Eigen::VectorXd flat(const std::vector<Point>& points) {
    return Eigen::Map<const Eigen::VectorXd>(points[0].data(), static_cast<Eigen::Index>(3 * points.size()));
}

}  // namespace

EnergyMeter::EnergyMeter(const Specimen& specimen, const SimulationConfig& config)
    : specimen_(specimen),
      body_(specimen.mesh, specimen.material),
      total_mass_kg_(body_.lumped_mass_kg().sum()),
      stiffness_n_per_m_(config.coupling_stiffness_n_per_m),
      tool_mass_kg_(config.coupling_stiffness_n_per_m > 0 ? config.tool_mass_kg : 0),
      potential_at_rest_j_(0) {
    for (std::size_t n = 0; n < specimen.asset.nodes_m.size(); ++n)
        potential_at_rest_j_ -= body_.lumped_mass_kg()[static_cast<Eigen::Index>(n)] *
                                vec(specimen.asset.gravity_m_per_s2).dot(vec(specimen.asset.nodes_m[n]));
    for (const ToolSet& tool : specimen.asset.tools)
        tools_before_m_.push_back(vec(tool.rest_position_m));
}

void EnergyMeter::work(const std::vector<Pose>& from, const std::vector<Pose>& to,
                       const std::vector<ToolResult>& results, double dt_s) {
    kinetic_of_tools_j_ = 0;
    for (std::size_t k = 0; k < to.size(); ++k) {
        const Eigen::Vector3d way = vec(to[k].position_m) - vec(from[k].position_m);
        const Eigen::AngleAxisd turned(turn(to[k]) * turn(from[k]).conjugate());
        const double work =
            -vec(results[k].force_n).dot(way) - turned.angle() * vec(results[k].torque_nm).dot(turned.axis());
        net_work_j_ += work;
        positive_work_j_ += std::max(work, 0.0);
        const Eigen::Vector3d velocity = (vec(results[k].tool_position_m) - tools_before_m_[k]) / dt_s;
        tools_before_m_[k] = vec(results[k].tool_position_m);
        kinetic_of_tools_j_ += 0.5 * tool_mass_kg_ * velocity.squaredNorm();
    }
}

double EnergyMeter::energy_j(const Snapshot& at, const std::vector<Pose>& hands,
                             const std::vector<ToolResult>& results) const {
    double energy = body_.energy_j(flat(at.state.positions_m)) + kinetic_of_tools_j_ - potential_at_rest_j_;
    const Eigen::Vector3d gravity = vec(specimen_.asset.gravity_m_per_s2);
    for (std::size_t n = 0; n < at.state.positions_m.size(); ++n) {
        const double mass = body_.lumped_mass_kg()[static_cast<Eigen::Index>(n)];
        energy += mass * (0.5 * vec(at.state.velocities_m_per_s[n]).squaredNorm() -
                          gravity.dot(vec(at.state.positions_m[n])));
    }
    for (std::size_t k = 0; k < results.size() && stiffness_n_per_m_ > 0; ++k)
        energy += 0.5 * stiffness_n_per_m_ *
                  (vec(hands[k].position_m) - vec(results[k].tool_position_m)).squaredNorm();
    return energy;
}

double EnergyMeter::slack_j() const {
    return 0.5 * total_mass_kg_ * criteria::kVelocityError_m_per_s * criteria::kVelocityError_m_per_s;
}

ContactMeter::Law ContactMeter::law(std::size_t tool, const Pose& pose, const ToolResult& result) const {
    const ToolSet& set = specimen_.asset.tools[tool];
    Law law;
    if (set.contact == ToolContact::bonded) return law;
    const bool plate = set.shape == ToolShape::plate;
    if (!plate && set.contact == ToolContact::sticking) return law;
    const Eigen::Vector3d away =
        plate ? Eigen::Vector3d(turn(pose) * Eigen::Vector3d::UnitZ()) : Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d force = vec(result.force_n);
    const double normal = force.dot(away);
    law.pull_n = std::max(0.0, -normal);
    if (!plate || set.contact == ToolContact::sticking) return law;
    const double friction = set.contact == ToolContact::coulomb ? set.friction_coefficient : 0;
    law.cone_excess_n = std::max(0.0, (force - normal * away).norm() - friction * std::max(0.0, normal));
    return law;
}

double ContactMeter::deepest_m(const Snapshot& at) const {
    double deepest = 0;
    for (std::size_t k = 0; k < at.tools.size(); ++k) {
        const ToolSet& set = specimen_.asset.tools[k];
        if (set.contact == ToolContact::bonded) continue;
        ContactTool tool = contact_tool(set, specimen_.asset.nodes_m);
        tool.pose = {at.tools[k].position_m, at.tools[k].orientation_wxyz};
        const ToolSurface surface(tool);
        for (const std::uint32_t node : set.nodes) {
            const Eigen::Vector3d local = surface.to_local(vec(at.state.positions_m[node]));
            if (!surface.beside(local)) deepest = std::max(deepest, -surface.nearest(local).gap_m);
        }
    }
    return deepest;
}

double off_rest(const Specimen& specimen, const Snapshot& at) {
    double sum = 0;
    for (std::size_t n = 0; n < at.state.positions_m.size(); ++n)
        sum += (vec(at.state.positions_m[n]) - vec(specimen.asset.nodes_m[n])).squaredNorm();
    return std::sqrt(sum / static_cast<double>(at.state.positions_m.size())) / specimen.size_m;
}

}  // namespace knead::tools::stability
