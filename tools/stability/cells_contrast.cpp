// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "stability/cells.h"
#include "stability/meshes.h"

namespace knead::tools::stability {
namespace {

constexpr std::uint32_t kContrastCells = 6;           // the 1,296 tetrahedra of the paper's smallest cube
constexpr std::uint32_t kContrastCellsShortened = 5;  // has the same eight islands

}  // namespace

void add_contrast_cells(Cells& cells) {
    const auto add = [&](double contrast, Layout layout, double nu, double dt_s) {
        const char* what = contrast == 1 ? "" : layout == Layout::islands ? "islands " : "percolating ";
        const std::string name = fmt::format("{}{:g}, nu {}, dt {} ms", what, contrast, nu, 1e3 * dt_s);
        cells.push_back(
            {"contrast", name, [=](const StabilityRequest& request, CellResult& result) {
                 PressCell cell;
                 cell.dt_s = dt_s;
                 const std::uint32_t n = request.shortened ? kContrastCellsShortened : kContrastCells;
                 cell.specimen = [=] {
                     Setting setting;
                     setting.tools = {bonded_plate()};
                     return make_specimen(contrast_cube(n, kSide_m, nu, contrast, layout), setting);
                 };
                 (void)run_press(cell, request, result);
             }});
    };
    for (const double contrast : {1.0, 1e2, 1e3, 1e4, 1e6, 1e9})
        for (const Layout layout : {Layout::percolating, Layout::islands})
            for (const double nu : {0.3, 0.49})
                for (const double dt_s : {1e-3, 10e-3})
                    if (contrast > 1 || layout == Layout::percolating) add(contrast, layout, nu, dt_s);
    // Around where steps begin to be linearised again.
    for (const double dt_s : {2e-3, 3e-3, 4e-3, 20e-3})
        add(1e9, Layout::islands, 0.49, dt_s);
    for (const double dt_s : {10e-3, 20e-3})
        add(1e9, Layout::islands, 0.39, dt_s);
}

}  // namespace knead::tools::stability
