// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "stability/judge.h"
#include "stability/run.h"
#include "stability/script.h"
#include "stability/specimen.h"
#include "stability/stability.h"

namespace knead::tools::stability {

/// One entry of the matrix.
struct Cell {
    std::string family;
    std::string name;  ///< without the family
    /// Runs and judges it: fills checks and steps.
    std::function<void(const StabilityRequest& request, CellResult& result)> run;
};
using Cells = std::vector<Cell>;

// The families, in the order of the matrix.
void add_contrast_cells(Cells& cells);      ///< soft and stiff matter in one object
void add_material_cells(Cells& cells);      ///< Young's modulus, Poisson's ratio, locking
void add_mesh_cells(Cells& cells);          ///< slivers, graded sizes
void add_scale_cells(Cells& cells);         ///< size and mass
void add_time_step_cells(Cells& cells);     ///< dt, jitter, out of range
void add_large_motion_cells(Cells& cells);  ///< compression, pull, shear, twist
void add_fast_tool_cells(Cells& cells);     ///< 0.1 to 10 m/s, teleports
void add_tool_cells(Cells& cells);          ///< shapes, contacts, several, coupled
void add_free_flight_cells(Cells& cells);
void add_odd_object_cells(Cells& cells);  ///< nothing free, one tetrahedron, several parts, inside out
void add_odd_input_cells(Cells& cells);   ///< not finite, denormal, out of range
void add_soak_cells(Cells& cells);
[[nodiscard]] Cells all_cells();

/// A run as most cells make it, and its judgement.
struct PressCell {
    std::function<Specimen()> specimen;
    Press press{{0, 0, -0.1 * kSide_m}};
    double dt_s = 1e-3;
    Demands demands = {};
    std::function<void(SimulationConfig&)> configure = {};
    std::function<void(const Specimen&, Script&)> rescript = {};
    bool compare_converged = true;
    std::function<void(const Specimen&, const Record&, CellResult&)> also = {};  ///< more checks
};
[[nodiscard]] Cell press_cell(const std::string& family, const std::string& name, PressCell cell);
/// The same, run now.
Record run_press(const PressCell& cell, const StabilityRequest& request, CellResult& result);

/// "1e6", "0.5", "10": short.
[[nodiscard]] std::string short_number(double value);

}  // namespace knead::tools::stability
