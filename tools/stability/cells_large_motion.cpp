// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>

#include "knead/formats/tool_names.h"
#include "stability/cells.h"
#include "stability/meshes.h"

namespace knead::tools::stability {
namespace {

/// A crushed body is softer against some motions than at rest, and slower to come to rest.
constexpr double kCrushed_s = 4;

Specimen cube_under(const SceneTool& tool, double nu, std::uint32_t cells = kCells) {
    Setting setting;
    setting.tools = {tool};
    return make_specimen(homogeneous(box_mesh({cells, cells, cells}, {kSide_m, kSide_m, kSide_m}),
                                     {kYoungsModulus_pa, nu, kDensity_kg_per_m3}),
                         setting);
}

/// Down (or up, if negative) by that share of the height and back.
Cell compression_cell(double share, double nu, ToolContact contact, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.press.way_m = {0, 0, -share * kSide_m};
    cell.press.leaves = contact != ToolContact::bonded;
    cell.press.longer_s = kCrushed_s;
    cell.demands.about = "recovery";
    cell.demands.contact_law = contact != ToolContact::bonded;
    cell.specimen = [=] {
        return cube_under(
            contact == ToolContact::bonded ? bonded_plate() : tool_above(ToolShape::plate, contact), nu);
    };
    return press_cell("large",
                      fmt::format("{} by {:g} %, {}, nu {}, dt {} ms", share > 0 ? "pressed" : "pulled",
                                  100 * std::abs(share), name_of(contact), nu, 1e3 * dt_s),
                      cell);
}

Cell twist_cell(double degrees, double nu, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.press.way_m = {};
    cell.press.turn = Eigen::AngleAxisd(degrees * M_PI / 180, Eigen::Vector3d::UnitZ());
    cell.demands.about = "recovery";
    cell.specimen = [=] { return cube_under(bonded_plate(), nu); };
    return press_cell("large",
                      fmt::format("twisted by {:g} degrees, nu {}, dt {} ms", degrees, nu, 1e3 * dt_s), cell);
}

Cell shear_cell(double share, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.press.way_m = {share * kSide_m, 0, 0};
    cell.demands.about = "recovery";
    cell.specimen = [=] { return cube_under(bonded_plate(), kPoissonsRatio); };
    return press_cell("large", fmt::format("sheared by {:g} %, dt {} ms", 100 * share, 1e3 * dt_s), cell);
}

/// The upper side laid over by half a turn about a horizontal axis.
Cell bend_cell(double degrees) {
    PressCell cell;
    cell.press.way_m = {0, 0, 0};
    cell.press.turn = Eigen::AngleAxisd(degrees * M_PI / 180, Eigen::Vector3d::UnitX());
    cell.demands.about = "recovery";
    cell.specimen = [=] { return cube_under(bonded_plate(), kPoissonsRatio); };
    return press_cell("large", fmt::format("bent by {:g} degrees", degrees), cell);
}

}  // namespace

void add_large_motion_cells(Cells& cells) {
    for (const double share : {0.3, 0.5, 0.7, 0.9})
        for (const double nu : {0.3, 0.49})
            cells.push_back(compression_cell(share, nu, ToolContact::bonded, 1e-3));
    cells.push_back(compression_cell(0.9, 0.3, ToolContact::bonded, 10e-3));
    for (const double share : {0.5, 0.9})
        for (const ToolContact contact :
             {ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb})
            cells.push_back(compression_cell(share, 0.3, contact, 1e-3));
    cells.push_back(compression_cell(-0.5, 0.3, ToolContact::bonded, 1e-3));
    cells.push_back(compression_cell(-2.0, 0.3, ToolContact::bonded, 1e-3));
    for (const double degrees : {90.0, 180.0, 360.0, 720.0})
        cells.push_back(twist_cell(degrees, 0.3, 1e-3));
    cells.push_back(twist_cell(720, 0.49, 1e-3));
    cells.push_back(twist_cell(720, 0.3, 10e-3));
    cells.push_back(shear_cell(1.0, 1e-3));
    cells.push_back(shear_cell(3.0, 1e-3));
    cells.push_back(bend_cell(180));
}

}  // namespace knead::tools::stability
