// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>

#include "reference/plate_press.h"
#include "stability/cells.h"
#include "stability/criteria.h"
#include "stability/meshes.h"

namespace knead::tools::stability {
namespace {

constexpr double kSoftest_pa = 1, kStiffest_pa = 200e9;

Cell stiffness_cell(double youngs_modulus_pa, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.specimen = [=] { return plain_cube({youngs_modulus_pa, kPoissonsRatio, kDensity_kg_per_m3}); };
    return press_cell("stiffness", fmt::format("E {:g} Pa, dt {} ms", youngs_modulus_pa, 1e3 * dt_s), cell);
}

Cell poisson_cell(double nu, double dt_s) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.specimen = [=] { return plain_cube({kYoungsModulus_pa, nu, kDensity_kg_per_m3}); };
    return press_cell("poisson", fmt::format("nu {}, dt {} ms", nu, 1e3 * dt_s), cell);
}

// ---- Uniform compression between frictionless plates: E A strain, whatever nu ---------------------------

constexpr double kStrain = 0.05;

Cell uniform_cell(double nu) {
    PressCell cell;
    cell.press.way_m = {0, 0, -kStrain * kSide_m};
    cell.demands.about = "analytic";
    cell.demands.recovery = false;  // nothing holds it where it was
    cell.demands.force_at_rest = true;
    cell.specimen = [=] {
        Setting setting;
        setting.held_bottom = false;
        SceneTool above = tool_above(ToolShape::plate, ToolContact::frictionless);
        SceneTool below = above;
        below.name = "below";
        below.touches = side_of_box("bottom");
        below.position_m = Point{kSide_m / 2, kSide_m / 2, 0};
        below.orientation_wxyz = {0, 1, 0, 0};  // its face looks up
        setting.tools = {above, below};
        return make_specimen(homogeneous(box_mesh({kCells, kCells, kCells}, {kSide_m, kSide_m, kSide_m}),
                                         {kYoungsModulus_pa, nu, kDensity_kg_per_m3}),
                             setting);
    };
    cell.rescript = [](const Specimen&, Script& script) {
        const auto both = script.move;
        script.move = [both](double time_s, std::vector<Pose>& poses) {
            const Pose below = poses[1];
            both(time_s, poses);
            poses[1] = below;
        };
    };
    cell.also = [](const Specimen&, const Record& record, CellResult& result) {
        const double expected_n = kYoungsModulus_pa * kSide_m * kSide_m * kStrain;
        Check check = must_be("analytic", false, "no force at rest");
        if (record.at_rest) {
            // at_rest.reference_n is the reference's; that it is also the runtime's is checked beside it.
            const double error = std::abs(record.at_rest->reference_n / expected_n - 1) +
                                 record.at_rest->difference_n / expected_n;
            check = at_most("analytic", error, criteria::kAnalytic, "relative to E A strain");
        }
        result.checks.insert(result.checks.begin(), check);
    };
    return press_cell("poisson", fmt::format("uniform compression, nu {}", nu), cell);
}

// ---- Locking --------------------------------------------------------------------------------------------

constexpr double kSmallStrain = 0.01;
constexpr std::uint32_t kFineCells =
    12;  // the reference's mesh; it locks too, so that an excess is a lower bound

double fine_force_n(double nu, std::uint32_t cells) {
    const MaterialObject object = homogeneous(box_mesh({cells, cells, cells}, {kSide_m, kSide_m, kSide_m}),
                                              {kYoungsModulus_pa, nu, kDensity_kg_per_m3});
    const PlatePress press = plate_press(object.mesh, kSmallStrain);
    return force_on_plate_n(press, StaticProblem(object.mesh, object.material).solve_linear(press.motion))[2];
}

Cell locking_cell(double nu) {
    PressCell cell;
    cell.press.way_m = {0, 0, -kSmallStrain * kSide_m};
    cell.specimen = [=] { return plain_cube({kYoungsModulus_pa, nu, kDensity_kg_per_m3}); };
    cell.demands.about = "locking";
    cell.also = [=](const Specimen&, const Record& record, CellResult& result) {
        const double fine_n = fine_force_n(nu, kFineCells);
        Check check = must_be("locking", false, "no force at rest");
        if (record.at_rest)
            check = at_most("locking", record.at_rest->reference_n / fine_n - 1, criteria::kMeshError,
                            "force above that of 10,368 tetrahedra", CellStatus::warn, Warning::locking);
        result.checks.insert(result.checks.begin(), check);
    };
    return press_cell("poisson", fmt::format("locking, nu {}", nu), cell);
}

}  // namespace

void add_material_cells(Cells& cells) {
    for (double e = kSoftest_pa; e < kStiffest_pa; e *= 10)
        cells.push_back(stiffness_cell(e, 1e-3));
    cells.push_back(stiffness_cell(kStiffest_pa, 1e-3));
    for (const double e : {kSoftest_pa, 1e3, 1e6, kStiffest_pa})
        cells.push_back(stiffness_cell(e, 10e-3));
    for (const double nu : {-0.5, 0.0, 0.2, 0.3, 0.4, 0.45, 0.49, 0.495, 0.499})
        cells.push_back(poisson_cell(nu, 1e-3));
    for (const double nu : {0.0, 0.49, 0.499})
        cells.push_back(poisson_cell(nu, 10e-3));
    for (const double nu : {0.0, 0.3, 0.49, 0.499})
        cells.push_back(uniform_cell(nu));
    for (const double nu : {0.3, 0.45, 0.49, 0.495, 0.499})
        cells.push_back(locking_cell(nu));
}

}  // namespace knead::tools::stability
