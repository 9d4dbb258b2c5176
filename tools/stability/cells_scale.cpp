// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "stability/cells.h"
#include "stability/meshes.h"

namespace knead::tools::stability {
namespace {

Cell size_cell(double side_m, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.press.way_m = {0, 0, -0.1 * side_m};
    cell.specimen = [=] { return plain_cube({}, kCells, side_m); };
    return press_cell("size", fmt::format("side {:g} m, dt {} ms", side_m, 1e3 * dt_s), cell);
}

Cell far_from_origin_cell(double away_m) {
    PressCell cell;
    cell.specimen = [=] {
        Setting setting;
        setting.tools = {bonded_plate()};
        MaterialObject object = homogeneous(box_mesh({kCells, kCells, kCells}, {kSide_m, kSide_m, kSide_m}));
        for (Point& node : object.mesh.nodes_m)
            for (double& coordinate : node)
                coordinate += away_m;
        return make_specimen(object, setting);
    };
    return press_cell("size", fmt::format("side 0.1 m, {:g} m from the origin", away_m), cell);
}

Cell mass_cell(double mass_kg, double side_m, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.press.way_m = {0, 0, -0.1 * side_m};
    cell.specimen = [=] {
        return plain_cube({kYoungsModulus_pa, kPoissonsRatio, mass_kg / (side_m * side_m * side_m)}, kCells,
                          side_m);
    };
    return press_cell("mass", fmt::format("{:g} kg in {:g} m, dt {} ms", mass_kg, side_m, 1e3 * dt_s), cell);
}

}  // namespace

void add_scale_cells(Cells& cells) {
    for (const double side_m : {1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0})
        cells.push_back(size_cell(side_m, 1e-3));
    for (const double side_m : {1e-3, 1.0, 10.0, 100.0})
        cells.push_back(size_cell(side_m, 20e-3));
    for (const double away_m : {1.0, 1e3, 1e5})
        cells.push_back(far_from_origin_cell(away_m));
    for (const double mass_kg : {1e-6, 1e-3, 1.0, 1e3}) {
        cells.push_back(mass_cell(mass_kg, kSide_m, 1e-3));
        cells.push_back(mass_cell(mass_kg, kSide_m, 10e-3));
    }
    cells.push_back(mass_cell(1e-6, 1e-2, 1e-3));
    cells.push_back(mass_cell(1e3, 1.0, 1e-3));
}

}  // namespace knead::tools::stability
