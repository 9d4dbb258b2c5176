// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "stability/cells.h"
#include "stability/meshes.h"

namespace knead::tools::stability {
namespace {

/// A crushed body is softer against some motions than at rest, and slower to come to rest.
constexpr double kCrushed_s = 4;

Specimen cube_under(const SceneTool& tool) {
    Setting setting;
    setting.tools = {tool};
    return make_specimen(homogeneous(box_mesh({kCells, kCells, kCells}, {kSide_m, kSide_m, kSide_m})),
                         setting);
}

struct Shape {
    const char* name;
    ToolShape shape;
    ToolContact contact;
};
constexpr Shape kBonded{"bonded plate", ToolShape::plate, ToolContact::bonded};
constexpr Shape kPlate{"frictionless plate", ToolShape::plate, ToolContact::frictionless};
constexpr Shape kBall{"Coulomb ball", ToolShape::sphere, ToolContact::coulomb};

PressCell base_cell(const Shape& shape, double share) {
    PressCell cell;
    cell.press.way_m = {0, 0, -share * kSide_m};
    const bool bonded = shape.contact == ToolContact::bonded;
    cell.press.leaves = !bonded;
    cell.demands.about = "passive";
    cell.demands.contact_law = !bonded;
    cell.specimen = [=] {
        return cube_under(bonded ? bonded_plate() : tool_above(shape.shape, shape.contact));
    };
    return cell;
}

Cell fast_cell(const Shape& shape, double speed_m_per_s, double share) {
    PressCell cell = base_cell(shape, share);
    cell.press.ramp_s = share * kSide_m / speed_m_per_s;
    return press_cell("fast", fmt::format("{} at {:g} m/s, {:g} %", shape.name, speed_m_per_s, 100 * share),
                      cell);
}

/// There within one step; back within one, too.
Cell teleport_cell(const Shape& shape, double share) {
    PressCell cell = base_cell(shape, share);
    cell.press.ramp_s = 0.5e-3;
    cell.press.longer_s = kCrushed_s;
    return press_cell("fast", fmt::format("{} teleported by {:g} %", shape.name, 100 * share), cell);
}

}  // namespace

void add_fast_tool_cells(Cells& cells) {
    for (const double speed : {1.0, 10.0}) {
        cells.push_back(fast_cell(kBonded, speed, 0.3));
        cells.push_back(fast_cell(kPlate, speed, 0.3));
        cells.push_back(fast_cell(kBall, speed, 0.3));
    }
    // Not 50 %: that mirrors the upper layer exactly, and a mirrored tetrahedron has many nearest rotations.
    for (const double share : {0.1, 0.45, 0.9})
        cells.push_back(teleport_cell(kBonded, share));
    cells.push_back(teleport_cell(kBonded, -10));  // a metre away: stretched elevenfold
    cells.push_back(teleport_cell(kPlate, 0.5));
    cells.push_back(teleport_cell(kBall, 0.5));
}

}  // namespace knead::tools::stability
