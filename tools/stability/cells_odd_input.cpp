// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "stability/cells.h"
#include "stability/criteria.h"
#include "stability/meshes.h"
#include "stability/meters.h"

namespace knead::tools::stability {
namespace {

constexpr double kDt_s = 1e-3;
constexpr int kSteps = 50;  // before and after the odd one
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kDenormal = 1e-310;

Pose pressed(const Pose& rest, int step) {
    Pose pose = rest;
    pose.position_m[2] -= 0.1 * kSide_m * step / (2.0 * kSteps);
    return pose;
}

bool same_state(const Simulation& a, const Simulation& b) {
    return std::memcmp(a.positions_m(), b.positions_m(), 3 * a.node_count() * sizeof(double)) == 0;
}

Specimen cube_under(ToolContact contact) {
    if (contact == ToolContact::bonded) return plain_cube();
    Setting setting;
    setting.tools = {tool_above(ToolShape::sphere, contact)};
    return make_specimen(homogeneous(box_mesh({kCells, kCells, kCells}, {kSide_m, kSide_m, kSide_m})),
                         setting);
}

/// One step that makes no sense among good ones: refused, without force, and as if it had not been.
Cell refused_cell(const std::string& name, ToolContact contact,
                  const std::function<void(Pose&, double&)>& spoil) {
    return {"input", name, [=](const StabilityRequest&, CellResult& result) {
                const Specimen specimen = cube_under(contact);
                Simulation simulation = simulation_of(specimen, config_for(specimen, kDt_s));
                Simulation twin = simulation_of(specimen, config_for(specimen, kDt_s));
                const Pose rest = simulation.tool_rest_pose();
                for (int k = 1; k <= kSteps; ++k) {
                    (void)simulation.step(pressed(rest, k), kDt_s);
                    (void)twin.step(pressed(rest, k), kDt_s);
                }
                Pose pose = pressed(rest, kSteps);
                double dt_s = kDt_s;
                spoil(pose, dt_s);
                const StepResult odd = simulation.step(pose, dt_s);
                const bool kept = same_state(simulation, twin);
                bool same_after = true;
                for (int k = kSteps + 1; k <= 2 * kSteps; ++k) {
                    const Vec3 a = simulation.step(pressed(rest, k), kDt_s).force_n;
                    const Vec3 b = twin.step(pressed(rest, k), kDt_s).force_n;
                    same_after = same_after && std::memcmp(&a, &b, sizeof a) == 0;
                }
                result.steps += 2 * kSteps + 1;
                result.checks.push_back(must_be("bad_input", odd.status == kStepBadInput,
                                                fmt::format("status bits {}", odd.status)));
                result.checks.push_back(must_be("no_force", odd.force_n == Vec3{} && odd.torque_nm == Vec3{},
                                                "there was a force"));
                result.checks.push_back(must_be("state_kept", kept, "nodes moved"));
                result.checks.push_back(must_be("as_if_not_been", same_after && same_state(simulation, twin),
                                                "later steps differ from those of a twin"));
            }};
}

/// Finite, but nowhere: whatever comes is finite or refused, and once the tool is back the object recovers.
Cell far_cell(double far_m, ToolContact contact) {
    return {"input",
            fmt::format("{} at {:g} m for ten steps",
                        contact == ToolContact::bonded ? "bonded plate" : "ball below,", far_m),
            [=](const StabilityRequest&, CellResult& result) {
                const Specimen specimen = cube_under(contact);
                Simulation simulation = simulation_of(specimen, config_for(specimen, kDt_s));
                const Pose rest = simulation.tool_rest_pose();
                Pose away = rest;
                away.position_m[2] -= far_m;
                bool finite = true;
                std::uint64_t told = 0;
                const auto steps = 10 + static_cast<std::uint64_t>(specimen.settle_s() / kDt_s);
                for (std::uint64_t k = 0; k < steps; ++k) {
                    const StepResult step = simulation.step(k < 10 ? away : rest, kDt_s);
                    const auto& f = step.force_n;
                    finite = finite && std::isfinite(f[0] + f[1] + f[2]);
                    told += step.status != kStepOk ? 1 : 0;
                }
                result.steps += steps;
                Snapshot end;
                end.state.positions_m.resize(simulation.node_count());
                std::copy_n(simulation.positions_m(), 3 * simulation.node_count(),
                            end.state.positions_m[0].data());
                result.checks.push_back(
                    at_most("recovery", off_rest(specimen, end), criteria::kOffRest, "of the size"));
                result.checks.push_back(must_be("finite", finite, "a force was not finite"));
                result.checks.back().note = fmt::format("{} of {} steps told something", told, steps);
            }};
}

/// A hand that hardly moves at all. Forces are compared while a pose can hold the motion.
Cell tiny_cell(double way_m) {
    constexpr double kHeldByPose_m = 1e-12;  // less is lost in a double beside 0.1 m
    PressCell cell;
    cell.press.way_m = {0, 0, -way_m};
    cell.demands.forces = cell.demands.force_at_rest = way_m >= kHeldByPose_m;
    cell.demands.energy = false;  // less than that of the velocity error
    cell.demands.about = "recovery";
    cell.specimen = [] { return plain_cube(); };
    return press_cell("input", fmt::format("a press of {:g} m", way_m), cell);
}

/// Values that a file may hold and float32 cannot: refused, or run without anything that is not finite.
Cell extreme_asset(const std::string& name, const std::function<void(Asset&)>& change) {
    return {"input", name, [=](const StabilityRequest&, CellResult& result) {
                Asset asset = plain_cube().asset;
                change(asset);
                const Result<Simulation> created = Simulation::create(asset);
                if (!created.ok()) {
                    result.checks.push_back(must_be("finite", true, ""));
                    result.checks.back().note = "refused: " + created.error().text();
                    return;
                }
                const Specimen specimen = specimen_of(asset);
                PressCell cell;
                cell.press.way_m = {0, 0, -0.1 * specimen.size_m};
                cell.press.ramp_s = 0.1;
                cell.press.holds = cell.press.rests = false;
                const Script script = press_script(specimen, cell.press, kDt_s);
                RunOptions options;
                options.config = config_for(specimen, kDt_s);
                options.force_at_rest = false;
                const Record record = run(specimen, script, options);
                result.steps += record.steps;
                Demands demands;
                demands.about = "finite";
                demands.forces = demands.force_at_rest = demands.energy = demands.recovery = false;
                result.checks = judge(record, demands, specimen.size_m);
                result.checks.push_back(must_be("force", record.largest_force_n > 0 || record.not_finite > 0,
                                                "no force and nothing told"));
            }};
}

void add_extreme_assets(Cells& cells) {
    for (const double e : {1e-310, 1e-40, 1e40, 1e300})
        cells.push_back(extreme_asset(fmt::format("E {:g} Pa", e),
                                      [=](Asset& asset) { asset.palette[0].youngs_modulus_pa = e; }));
    for (const double rho : {1e-310, 1e-40, 1e40, 1e300})
        cells.push_back(extreme_asset(fmt::format("density {:g} kg/m^3", rho),
                                      [=](Asset& asset) { asset.palette[0].density_kg_per_m3 = rho; }));
    for (const double scale : {1e-30, 1e-12, 1e12, 1e30})
        cells.push_back(extreme_asset(fmt::format("side {:g} m", kSide_m * scale), [=](Asset& asset) {
            for (Point& node : asset.nodes_m)
                for (double& x : node)
                    x *= scale;
            for (double& x : asset.tools[0].rest_position_m)
                x *= scale;
        }));
}

}  // namespace

void add_odd_input_cells(Cells& cells) {
    for (const ToolContact contact : {ToolContact::bonded, ToolContact::coulomb}) {
        const std::string tool = contact == ToolContact::bonded ? "bonded plate" : "Coulomb ball";
        cells.push_back(
            refused_cell(tool + " at NaN", contact, [](Pose& p, double&) { p.position_m[1] = kNan; }));
        cells.push_back(
            refused_cell(tool + " at infinity", contact, [](Pose& p, double&) { p.position_m[2] = -kInf; }));
        cells.push_back(refused_cell(tool + " turned by NaN", contact,
                                     [](Pose& p, double&) { p.orientation_wxyz[2] = kNan; }));
        cells.push_back(refused_cell(tool + " turned by a zero quaternion", contact, [](Pose& p, double&) {
            p.orientation_wxyz = {0, 0, 0, 0};
        }));
    }
    const ToolContact bonded = ToolContact::bonded;
    cells.push_back(refused_cell("quaternion of norm 2", bonded, [](Pose& p, double&) {
        p.orientation_wxyz = {2, 0, 0, 0};
    }));
    cells.push_back(refused_cell("quaternion of infinity", bonded, [](Pose& p, double&) {
        p.orientation_wxyz = {kInf, 0, 0, 0};
    }));
    cells.push_back(refused_cell("denormal quaternion", bonded, [](Pose& p, double&) {
        p.orientation_wxyz = {kDenormal, 0, 0, 0};
    }));
    for (const double dt_s : {kNan, kInf, 0.0, -1e-3, kDenormal, 1.0})
        cells.push_back(
            refused_cell(fmt::format("dt {:g} s", dt_s), bonded, [=](Pose&, double& dt) { dt = dt_s; }));
    for (const double far_m : {1e3, 1e10, 1e30, 1e300})
        cells.push_back(far_cell(far_m, ToolContact::bonded));
    cells.push_back(far_cell(1e3, ToolContact::frictionless));
    cells.push_back(far_cell(1e300, ToolContact::frictionless));
    for (const double way_m : {1e-6, 1e-9, 1e-20, 1e-40, kDenormal})
        cells.push_back(tiny_cell(way_m));
    add_extreme_assets(cells);
}

}  // namespace knead::tools::stability
