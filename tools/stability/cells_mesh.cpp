// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "stability/cells.h"
#include "stability/criteria.h"
#include "stability/meshes.h"

namespace knead::tools::stability {
namespace {

constexpr std::size_t kEverySliver = 10;  // a tenth of the tetrahedra is spoilt
/// How near the mesh must be to the angle that the cell says.
constexpr double kAngleTolerance = 1e-3;

double degrees(double radians) {
    return 180 / M_PI * radians;
}

Setting pressed_by(const SceneTool& tool) {
    Setting setting;
    setting.tools = {tool};
    return setting;
}

/// What the clean mesh says to the same press.
double clean_force_n(double nu, double way_m) {
    const Specimen clean = plain_cube({kYoungsModulus_pa, nu, kDensity_kg_per_m3});
    PrescribedMotion motion = clean.held;
    for (const std::uint32_t node : clean.asset.tools[0].nodes) {
        motion.nodes.push_back(node);
        motion.displacement_m.push_back({0, 0, way_m});
    }
    const StaticSolution solution = StaticProblem(clean.mesh, clean.material).solve(motion);
    double force = 0;
    for (std::size_t i = clean.held.nodes.size(); i < motion.nodes.size(); ++i)
        force += solution.reactions_n[i][2];
    return force;
}

Cell sliver_cell(Flaw flaw, double angle_deg, double nu, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.specimen = [=] {
        const TetMesh mesh = with_slivers(box_mesh({kCells, kCells, kCells}, {kSide_m, kSide_m, kSide_m}),
                                          flaw, angle_deg * M_PI / 180, kEverySliver);
        return make_specimen(homogeneous(mesh, {kYoungsModulus_pa, nu, kDensity_kg_per_m3}),
                             pressed_by(bonded_plate()));
    };
    const double way_m = cell.press.way_m[2];
    cell.also = [=](const Specimen& specimen, const Record& record, CellResult& result) {
        const double found = degrees(smallest_dihedral_rad(specimen.mesh));
        result.checks.push_back(at_most("dihedral", std::abs(found / angle_deg - 1), kAngleTolerance,
                                        "relative to the angle wanted"));
        if (!record.at_rest) return;
        const double off = record.at_rest->reference_n / clean_force_n(nu, way_m) - 1;
        result.checks.push_back(at_most("against_clean_mesh", std::abs(off), criteria::kMeshError,
                                        "force relative to the mesh without slivers", CellStatus::warn,
                                        Warning::slivers));
    };
    return press_cell("mesh",
                      fmt::format("slivers {} at {} degrees, nu {}, dt {} ms",
                                  flaw == Flaw::near_face ? "flat" : "thin", angle_deg, nu, 1e3 * dt_s),
                      cell);
}

/// Fine at the corner that a ball presses, or far from it.
Cell graded_cell(std::uint32_t ratio, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.specimen = [=] {
        return make_specimen(homogeneous(graded_corner(kSide_m, ratio)), pressed_by(bonded_plate()));
    };
    return press_cell("mesh", fmt::format("sizes 1 to {}, dt {} ms", ratio, 1e3 * dt_s), cell);
}

/// The fine corner itself is pressed: by so little that it is not crushed.
Cell graded_touch_cell(std::uint32_t ratio, double dt_s) {
    constexpr double kPressed = 0.5;  // of the smallest cells
    PressCell cell;
    cell.dt_s = dt_s;
    cell.press.way_m = {0, 0, kPressed * kSide_m / (2 * ratio)};
    cell.specimen = [=] {
        SceneTool tool = bonded_plate();
        tool.touches = {};
        tool.touches.scene_key = "corner";
        const double half_m = 0.75 * kSide_m / ratio;
        tool.touches.box_m =
            std::array<Point, 2>{Point{-half_m, -half_m, -half_m}, Point{half_m, half_m, 1e-9}};
        tool.position_m = Point{0, 0, 0};
        Setting setting = pressed_by(tool);
        setting.held_bottom = false;
        Specimen specimen = make_specimen(homogeneous(graded_corner(kSide_m, ratio)), setting);
        return specimen;
    };
    cell.demands.recovery = false;  // nothing holds it
    cell.demands.force_at_rest = false;
    return press_cell(
        "mesh", fmt::format("sizes 1 to {}, pressed at the fine corner, dt {} ms", ratio, 1e3 * dt_s), cell);
}

/// A sheet: all tetrahedra flat.
Cell sheet_cell(double thickness, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.press.way_m = {0, 0, -0.1 * thickness * kSide_m};
    cell.specimen = [=] {
        return make_specimen(
            homogeneous(box_mesh({kCells, kCells, 2}, {kSide_m, kSide_m, thickness * kSide_m})),
            pressed_by(bonded_plate()));
    };
    return press_cell("mesh",
                      fmt::format("sheet of thickness 1 to {:g}, dt {} ms", 1 / thickness, 1e3 * dt_s), cell);
}

}  // namespace

void add_mesh_cells(Cells& cells) {
    for (const Flaw flaw : {Flaw::near_face, Flaw::near_edge})
        for (const double angle : {10.0, 5.0, 2.0, 1.0, 0.5})
            cells.push_back(sliver_cell(flaw, angle, 0.3, 1e-3));
    for (const double angle : {1.0, 0.5}) {
        cells.push_back(sliver_cell(Flaw::near_face, angle, 0.49, 1e-3));
        cells.push_back(sliver_cell(Flaw::near_face, angle, 0.3, 10e-3));
        cells.push_back(sliver_cell(Flaw::near_edge, angle, 0.49, 10e-3));
    }
    for (const std::uint32_t ratio : {16U, 128U, 1024U})
        for (const double dt_s : {1e-3, 10e-3})
            cells.push_back(graded_cell(ratio, dt_s));
    cells.push_back(graded_touch_cell(1024, 1e-3));
    cells.push_back(graded_touch_cell(1024, 10e-3));
    for (const double thickness : {0.01, 0.001})
        cells.push_back(sheet_cell(thickness, 1e-3));
}

}  // namespace knead::tools::stability
