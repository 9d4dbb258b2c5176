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
    for (const double contrast : {1.0, 1e2, 1e3, 1e4, 1e6, 1e9})
        for (const Layout layout : {Layout::percolating, Layout::islands})
            for (const double nu : {0.3, 0.49})
                for (const double dt_s : {1e-3, 10e-3}) {
                    if (contrast == 1 && layout == Layout::islands) continue;
                    const char* what = contrast == 1               ? "none"
                                       : layout == Layout::islands ? "islands"
                                                                   : "percolating";
                    const std::string name = contrast == 1 ? fmt::format("1, nu {}, dt {} ms", nu, 1e3 * dt_s)
                                                           : fmt::format("{} {:g}, nu {}, dt {} ms", what,
                                                                         contrast, nu, 1e3 * dt_s);
                    cells.push_back(
                        {"contrast", name, [=](const StabilityRequest& request, CellResult& result) {
                             PressCell cell;
                             cell.dt_s = dt_s;
                             const std::uint32_t n =
                                 request.shortened ? kContrastCellsShortened : kContrastCells;
                             cell.specimen = [=] {
                                 Setting setting;
                                 setting.tools = {bonded_plate()};
                                 return make_specimen(contrast_cube(n, kSide_m, nu, contrast, layout),
                                                      setting);
                             };
                             (void)run_press(cell, request, result);
                         }});
                }
}

}  // namespace knead::tools::stability
