// SPDX-License-Identifier: GPL-3.0-or-later
#include "stability/cells.h"

#include <fmt/format.h>

#include <utility>

#include "stability/criteria.h"

namespace knead::tools::stability {
namespace {

/// In CI: fewer comparisons, for each is a direct factor or more.
constexpr std::size_t kComparedStepsShortened = 6;

}  // namespace

std::string short_number(double value) {
    return fmt::format("{:g}", value);
}

Record run_press(const PressCell& cell, const StabilityRequest& request, CellResult& result) {
    const Specimen specimen = cell.specimen();
    Script script = press_script(specimen, cell.press, cell.dt_s);
    if (cell.rescript) cell.rescript(specimen, script);
    RunOptions options;
    options.config = config_for(specimen, cell.dt_s);
    if (cell.configure) cell.configure(options.config);
    options.compared_steps = !cell.demands.forces ? 0
                             : request.shortened  ? kComparedStepsShortened
                                                  : criteria::kComparedSteps;
    options.compare_converged = cell.compare_converged;
    options.force_at_rest = cell.demands.force_at_rest && cell.press.holds;
    const Record record = run(specimen, script, options);
    Demands demands = cell.demands;
    demands.force_at_rest = options.force_at_rest;
    demands.recovery = demands.recovery && cell.press.rests;
    const std::vector<Check> checks = judge(record, demands, specimen.size_m);
    result.checks.insert(result.checks.end(), checks.begin(), checks.end());
    result.steps += record.steps;
    if (cell.also) cell.also(specimen, record, result);
    return record;
}

Cell press_cell(const std::string& family, const std::string& name, PressCell cell) {
    return {family, name, [cell = std::move(cell)](const StabilityRequest& request, CellResult& result) {
                (void)run_press(cell, request, result);
            }};
}

Cells all_cells() {
    Cells cells;
    add_contrast_cells(cells);
    add_material_cells(cells);
    add_mesh_cells(cells);
    add_scale_cells(cells);
    add_time_step_cells(cells);
    add_large_motion_cells(cells);
    add_fast_tool_cells(cells);
    add_tool_cells(cells);
    add_free_flight_cells(cells);
    add_odd_object_cells(cells);
    add_odd_input_cells(cells);
    add_soak_cells(cells);
    return cells;
}

}  // namespace knead::tools::stability
