// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

#include "reference/elastic_body.h"
#include "stability/cells.h"
#include "stability/criteria.h"
#include "stability/meshes.h"

namespace knead::tools::stability {
namespace {

/// A ball beside the middle hits the body, which nothing holds, and goes.
struct Shot {
    double youngs_modulus_pa = kYoungsModulus_pa;
    double poissons_ratio = kPoissonsRatio;
    double dt_s = 1e-3;
    double speed_m_per_s = 0.5;
    double flight_s = 1;
};

constexpr double kDepth = 0.2;  // of the side
constexpr double kAside = 0.3;  // of the side: from the middle
/// Until what the hit left vibrating is almost gone, in passages of a shear wave.
constexpr double kCalmTimes = 10;

struct Motion {
    Eigen::Matrix3Xd velocities;                         ///< [nodes] beyond that of the centre of mass, m/s
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  ///< kg m/s
    Eigen::Vector3d spin = Eigen::Vector3d::Zero();      ///< about the centre of mass, kg m^2/s
    double energy_j = 0;
    bool finite = true;
};

Motion motion_of(const ElasticBody& body, const Simulation& simulation) {
    const auto nodes = static_cast<Eigen::Index>(simulation.node_count());
    const Eigen::Matrix3Xd x = Eigen::Map<const Eigen::Matrix3Xd>(simulation.positions_m(), 3, nodes);
    Eigen::Matrix3Xd v(3, nodes);
    simulation.velocities_m_per_s(v.data());
    const Eigen::VectorXd& mass = body.lumped_mass_kg();
    const Eigen::Vector3d middle = x * mass / mass.sum();
    Motion motion;
    motion.momentum = v * mass;
    motion.finite = x.allFinite() && v.allFinite();
    motion.velocities = v.colwise() - motion.momentum / mass.sum();
    for (Eigen::Index i = 0; i < nodes; ++i) {
        const Eigen::Vector3d arm = x.col(i) - middle, velocity = v.col(i);
        motion.spin += mass[i] * arm.cross(velocity);
        motion.energy_j += 0.5 * mass[i] * velocity.squaredNorm();
    }
    motion.energy_j += body.energy_j(Eigen::Map<const Eigen::VectorXd>(x.data(), 3 * nodes));
    return motion;
}

/// What implicit Euler itself, solved to the end, makes of the angular momentum in a step of a body on which
/// nothing acts. Forces without a torque about where they act give sum m x1 x (v1 - v0) = 0, and with
/// x1 = x0 + dt v1 the angular momentum changes by dt sum m v1 x v0: it brakes a spin, and takes from or
/// gives to one what vibrates.
Eigen::Vector3d spin_of_implicit_euler(const ElasticBody& body, const Motion& before, const Motion& after,
                                       double dt_s) {
    Eigen::Vector3d change = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < after.velocities.cols(); ++i) {
        const Eigen::Vector3d v0 = before.velocities.col(i), v1 = after.velocities.col(i);
        change += dt_s * body.lumped_mass_kg()[i] * v1.cross(v0);
    }
    return change;
}

Specimen free_cube(const Shot& shot) {
    Setting setting;
    setting.held_bottom = false;
    setting.damped = false;
    SceneTool ball = tool_above(ToolShape::sphere, ToolContact::frictionless);
    ball.position_m = Point{(0.5 + kAside) * kSide_m, 0.5 * kSide_m, kSide_m + ball.radius_m};
    setting.tools = {ball};
    return make_specimen(homogeneous(box_mesh({kCells, kCells, kCells}, {kSide_m, kSide_m, kSide_m}),
                                     {shot.youngs_modulus_pa, shot.poissons_ratio, kDensity_kg_per_m3}),
                         setting);
}

void fly(const Shot& shot, CellResult& result) {
    const Specimen specimen = free_cube(shot);
    Simulation simulation = simulation_of(specimen, config_for(specimen, shot.dt_s));
    const ElasticBody body(specimen.mesh, specimen.material);
    const Pose rest = simulation.tool_rest_pose();
    const double hit_s = std::max(kDepth * kSide_m / shot.speed_m_per_s, 5 * shot.dt_s);
    const double calm_s = 2 * hit_s + kCalmTimes * kSide_m / specimen.shear_speed_m_per_s;
    Eigen::Vector3d impulse = Eigen::Vector3d::Zero(), of_the_method = Eigen::Vector3d::Zero();
    Motion start, now;
    bool started = false, finite = true;
    double worst_momentum = 0, spin_growth = 0, energy_growth = 0, touching_after = 0;
    std::uint32_t status = 0, most_iterations = 0;
    const auto steps = static_cast<std::uint64_t>((calm_s + shot.flight_s) / shot.dt_s);
    for (std::uint64_t k = 1; k <= steps; ++k) {
        const double time_s = static_cast<double>(k) * shot.dt_s;
        Pose pose = rest;
        const double in = std::min(1.0, time_s / hit_s), out = std::clamp((time_s - hit_s) / hit_s, 0.0, 1.0);
        // It leaves upwards; the body flies down.
        pose.position_m[2] += -kDepth * kSide_m * in + 10 * kSide_m * out;
        const StepResult step = simulation.step(pose, shot.dt_s);
        impulse -= shot.dt_s * Eigen::Map<const Eigen::Vector3d>(step.force_n.data());
        status |= step.status;
        most_iterations = std::max(most_iterations, step.solver_iterations);
        if (time_s < calm_s) continue;
        const Motion before = std::exchange(now, motion_of(body, simulation));
        finite = finite && now.finite;
        touching_after += step.touched_nodes;
        if (!started) {
            start = now;
            started = true;
        } else {
            of_the_method += spin_of_implicit_euler(body, before, now, shot.dt_s);
        }
        worst_momentum =
            std::max(worst_momentum, (now.momentum - start.momentum).norm() / start.momentum.norm());
        spin_growth = std::max(spin_growth, (now.spin - of_the_method).norm() / start.spin.norm() - 1);
        energy_growth = std::max(energy_growth, now.energy_j / start.energy_j - 1);
    }
    result.steps += steps;
    result.checks.push_back(at_most("momentum", worst_momentum, criteria::kMomentum, "relative"));
    result.checks.push_back(must_be("finite", finite, "not finite"));
    result.checks.push_back(must_be("status", status == kStepOk, fmt::format("status bits {}", status)));
    result.checks.push_back(
        must_be("flies", touching_after == 0 && start.spin.norm() > 0, "it does not fly free"));
    result.checks.push_back(at_most("impulse", (impulse - start.momentum).norm() / impulse.norm(),
                                    criteria::kMomentum, "momentum against what the tool gave"));
    result.checks.push_back(at_most("spin_growth", spin_growth, criteria::kMomentum,
                                    "relative, beyond what implicit Euler does"));
    result.checks.push_back(at_most("energy_growth", energy_growth, criteria::kMomentum, "relative"));
    result.checks.push_back(at_most("spin_loss", 1 - now.spin.norm() / start.spin.norm(), criteria::kSpinLoss,
                                    fmt::format("in {:g} s", shot.flight_s), CellStatus::warn,
                                    Warning::spin_loss));
    result.checks.push_back(at_most("iterations", most_iterations, criteria::kMeanIterations,
                                    "at most a step", CellStatus::warn, Warning::iterations));
}

Cell flight_cell(const Shot& shot) {
    return {"free",
            fmt::format("hit aside at {:g} m/s, E {:g} Pa, nu {}, dt {} ms, {:g} s", shot.speed_m_per_s,
                        shot.youngs_modulus_pa, shot.poissons_ratio, 1e3 * shot.dt_s, shot.flight_s),
            [=](const StabilityRequest&, CellResult& result) { fly(shot, result); }};
}

/// Falling without being touched: g t, and nothing else.
Cell fall_cell(double dt_s, double fall_s) {
    return {
        "free", fmt::format("fall of {:g} s, dt {} ms", fall_s, 1e3 * dt_s),
        [=](const StabilityRequest&, CellResult& result) {
            constexpr double kGravity = 9.81;
            Setting setting;
            setting.held_bottom = setting.damped = false;
            setting.gravity_m_per_s2 = {0, 0, -kGravity};
            setting.tools = {tool_above(ToolShape::sphere, ToolContact::frictionless)};
            const Specimen specimen = make_specimen(
                homogeneous(box_mesh({kCells, kCells, kCells}, {kSide_m, kSide_m, kSide_m})), setting);
            Simulation simulation = simulation_of(specimen, config_for(specimen, dt_s));
            const ElasticBody body(specimen.mesh, specimen.material);
            Pose away = simulation.tool_rest_pose();
            away.position_m[2] += 10;
            std::uint32_t status = 0;
            const auto steps = static_cast<std::uint64_t>(std::lround(fall_s / dt_s));
            for (std::uint64_t k = 0; k < steps; ++k)
                status |= simulation.step(away, dt_s).status;
            result.steps += steps;
            const Motion motion = motion_of(body, simulation);
            const double mass_kg = body.lumped_mass_kg().sum();
            const Eigen::Vector3d expected(0, 0, -mass_kg * kGravity * fall_s);
            result.checks.push_back(at_most("momentum", (motion.momentum - expected).norm() / expected.norm(),
                                            criteria::kMomentum, "relative to m g t"));
            result.checks.push_back(
                must_be("status", status == kStepOk, fmt::format("status bits {}", status)));
            result.checks.push_back(at_most("spin", motion.spin.norm() / (expected.norm() * kSide_m),
                                            criteria::kMomentum, "of the momentum times the side"));
            double strain_j = motion.energy_j - 0.5 * motion.momentum.squaredNorm() / mass_kg;
            result.checks.push_back(at_most("strain", std::abs(strain_j) / motion.energy_j,
                                            criteria::kMomentum, "energy beside that of the fall"));
        }};
}

}  // namespace

void add_free_flight_cells(Cells& cells) {
    cells.push_back(flight_cell({}));
    cells.push_back(flight_cell({.dt_s = 0.25e-3}));
    cells.push_back(flight_cell({.dt_s = 5e-3}));
    cells.push_back(flight_cell({.dt_s = 20e-3}));
    cells.push_back(flight_cell({.poissons_ratio = 0.49}));
    cells.push_back(flight_cell({.youngs_modulus_pa = 1e3}));
    for (const double e_pa : {1e6, 1e7, 1e8, 1e9, 1e10, 2e11})
        cells.push_back(flight_cell({.youngs_modulus_pa = e_pa}));
    cells.push_back(flight_cell({.youngs_modulus_pa = 1e9, .dt_s = 5e-3}));
    cells.push_back(flight_cell({.youngs_modulus_pa = 1e9, .poissons_ratio = 0.49}));
    cells.push_back(flight_cell({.youngs_modulus_pa = 1e9, .flight_s = 10}));
    cells.push_back(flight_cell({.youngs_modulus_pa = 1e6, .speed_m_per_s = 5}));
    cells.push_back(flight_cell({.youngs_modulus_pa = 1e9, .speed_m_per_s = 5}));
    cells.push_back(flight_cell({.speed_m_per_s = 5}));
    cells.push_back(flight_cell({.flight_s = 10}));
    cells.push_back(fall_cell(1e-3, 10));
    cells.push_back(fall_cell(20e-3, 10));
}

}  // namespace knead::tools::stability
