// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "knead/formats/tool_names.h"
#include "stability/cells.h"
#include "stability/meshes.h"

namespace knead::tools::stability {
namespace {

constexpr double kPressed = 0.15;
constexpr double kSlide_s = 0.5;

MaterialObject cube(const Matter& matter = {}) {
    return homogeneous(box_mesh({kCells, kCells, kCells}, {kSide_m, kSide_m, kSide_m}), matter);
}

Specimen cube_under(std::vector<SceneTool> tools, const Matter& matter = {}) {
    Setting setting;
    setting.tools = std::move(tools);
    return make_specimen(cube(matter), setting);
}

Cell shape_cell(ToolShape shape, ToolContact contact, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    const bool bonded = contact == ToolContact::bonded;
    cell.press.way_m = {0, 0, -kPressed * kSide_m};
    cell.press.leaves = !bonded;
    cell.demands.contact_law = !bonded;
    cell.specimen = [=] { return cube_under({tool_above(shape, contact)}); };
    return press_cell("tool", fmt::format("{} {}, dt {} ms", name_of(shape), name_of(contact), 1e3 * dt_s),
                      cell);
}

/// Down, then along the upper side by half of it, then away.
Cell sliding_cell(ToolShape shape, ToolContact contact, double nu) {
    PressCell cell;
    cell.press.way_m = {0, 0, -0.1 * kSide_m};
    cell.press.leaves = true;
    cell.press.longer_s = kSlide_s;
    cell.demands.contact_law = true;
    cell.demands.about = "passive";
    cell.specimen = [=] {
        return cube_under({tool_above(shape, contact)}, {kYoungsModulus_pa, nu, kDensity_kg_per_m3});
    };
    cell.rescript = [](const Specimen&, Script& script) {
        const auto press = script.move;
        const double from_s = script.still_s, way_m = 0.3 * kSide_m;
        script.still_s += kSlide_s;
        script.move = [=](double time_s, std::vector<Pose>& poses) {
            press(time_s, poses);
            const double share = std::clamp((time_s - from_s) / kSlide_s, 0.0, 1.0);
            for (Pose& pose : poses)
                pose.position_m[0] += share * way_m;
        };
    };
    return press_cell("tool", fmt::format("{} {} sliding, nu {}", name_of(shape), name_of(contact), nu),
                      cell);
}

// ---- Several --------------------------------------------------------------------------------------------

SceneTool half_ball(const char* name, double x, ToolContact contact) {
    SceneTool tool = tool_above(ToolShape::sphere, contact);
    tool.name = name;
    tool.radius_m = 0.2 * kSide_m;
    tool.touches.box_m = std::array<Point, 2>{Point{(x - 0.25) * kSide_m - 1e-9, 0, 0},
                                              Point{(x + 0.25) * kSide_m - 1e-9, kSide_m, kSide_m}};
    tool.position_m = Point{x * kSide_m, 0.5 * kSide_m, 1.2 * kSide_m};
    return tool;
}

Cell several_cell(const std::string& name, double dt_s, const std::function<std::vector<SceneTool>()>& tools,
                  bool leaves) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.press.way_m = {0, 0, -0.1 * kSide_m};
    cell.press.leaves = leaves;
    cell.demands.contact_law = leaves;
    cell.specimen = [=] { return cube_under(tools()); };
    return press_cell("tool", fmt::format("{}, dt {} ms", name, 1e3 * dt_s), cell);
}

std::vector<SceneTool> two_balls() {
    return {half_ball("left", 0.25, ToolContact::frictionless),
            half_ball("right", 0.75, ToolContact::coulomb)};
}

std::vector<SceneTool> two_bonded() {
    SceneTool left = bonded_plate(), right = bonded_plate();
    left.name = "left";
    right.name = "right";
    left.touches.box_m = std::array<Point, 2>{Point{0, 0, 0}, Point{0.3 * kSide_m, kSide_m, kSide_m}};
    right.touches.box_m = std::array<Point, 2>{Point{0.7 * kSide_m, 0, 0}, Point{kSide_m, kSide_m, kSide_m}};
    return {left, right};
}

std::vector<SceneTool> bonded_and_ball() {
    SceneTool bonded = two_bonded()[0];
    return {bonded, half_ball("ball", 0.75, ToolContact::sticking)};
}

// ---- Coupled --------------------------------------------------------------------------------------------

Cell coupled_cell(double stiffness, double damping, double mass_kg, ToolContact contact, double dt_s) {
    PressCell cell;
    // Until the tool on its spring is at rest: as slow as its own swing, or as its damper makes it.
    cell.press.longer_s = 12 * std::max(2 * mass_kg / damping, damping / stiffness);
    cell.dt_s = dt_s;
    const bool bonded = contact == ToolContact::bonded;
    cell.press.way_m = {0, 0, -0.1 * kSide_m};
    cell.press.leaves = !bonded;
    cell.demands.contact_law = false;  // the coupling may pull the hand while the tool is braked
    cell.demands.forces = false;       // the reference has no coupling; at rest it needs none
    cell.demands.about = "force_at_rest";
    cell.configure = [=](SimulationConfig& config) {
        config.coupling_stiffness_n_per_m = stiffness;
        config.coupling_damping_n_s_per_m = damping;
        config.tool_mass_kg = mass_kg;
    };
    cell.specimen = [=] {
        return cube_under({bonded ? bonded_plate() : tool_above(ToolShape::sphere, contact)});
    };
    return press_cell("tool",
                      fmt::format("{} coupled by {:g} N/m and {:g} N s/m, {:g} kg, dt {} ms",
                                  name_of(contact), stiffness, damping, mass_kg, 1e3 * dt_s),
                      cell);
}

}  // namespace

void add_tool_cells(Cells& cells) {
    for (const ToolShape shape : {ToolShape::plate, ToolShape::sphere, ToolShape::capsule})
        for (const ToolContact contact :
             {ToolContact::bonded, ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb})
            for (const double dt_s : {1e-3, 10e-3})
                if (contact != ToolContact::bonded || shape != ToolShape::plate)  // that is every other cell
                    cells.push_back(shape_cell(shape, contact, dt_s));
    for (const double nu : {0.3, 0.49}) {
        cells.push_back(sliding_cell(ToolShape::plate, ToolContact::coulomb, nu));
        cells.push_back(sliding_cell(ToolShape::sphere, ToolContact::coulomb, nu));
    }
    cells.push_back(sliding_cell(ToolShape::sphere, ToolContact::frictionless, 0.3));
    for (const double dt_s : {1e-3, 10e-3}) {
        cells.push_back(several_cell("two balls", dt_s, two_balls, true));
        cells.push_back(several_cell("two bonded plates", dt_s, two_bonded, false));
        cells.push_back(several_cell("bonded plate and sticking ball", dt_s, bonded_and_ball, false));
    }
    cells.push_back(coupled_cell(500, 1, 0.05, ToolContact::bonded, 1e-3));
    cells.push_back(coupled_cell(500, 1, 0.05, ToolContact::frictionless, 1e-3));
    cells.push_back(coupled_cell(500, 1, 0.05, ToolContact::coulomb, 10e-3));
    cells.push_back(coupled_cell(1e7, 10, 1e-6, ToolContact::bonded, 1e-3));
    cells.push_back(coupled_cell(1e7, 10, 1e-6, ToolContact::frictionless, 1e-3));
    cells.push_back(coupled_cell(10, 20, 10, ToolContact::sticking, 1e-3));
}

}  // namespace knead::tools::stability
