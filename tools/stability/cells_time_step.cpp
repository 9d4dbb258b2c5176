// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>

#include "stability/cells.h"

namespace knead::tools::stability {
namespace {

constexpr double kShortest_s = 0.25e-3, kLongest_s = 20e-3;  // what the runtime promises

Cell steady_cell(double nu, double dt_s, ToolContact contact) {
    PressCell cell;
    cell.dt_s = dt_s;
    cell.specimen = [=] {
        if (contact == ToolContact::bonded) return plain_cube({kYoungsModulus_pa, nu, kDensity_kg_per_m3});
        Specimen specimen = plain_cube({kYoungsModulus_pa, nu, kDensity_kg_per_m3});
        specimen.asset.tools[0].contact = contact;
        return specimen;
    };
    if (contact != ToolContact::bonded) {
        cell.press.leaves = true;
        cell.demands.contact_law = true;
    }
    return press_cell("dt",
                      fmt::format("{} ms, nu {}, {}", 1e3 * dt_s, nu,
                                  contact == ToolContact::bonded ? "bonded" : "frictionless"),
                      cell);
}

// ---- Varying dt -----------------------------------------------------------------------------------------

/// Uniform in [0, 1) for each step, the same on every platform and in whatever order it is asked.
double draw(std::size_t step) {
    std::mt19937_64 engine(step + 1);
    return static_cast<double>(engine() >> 11U) * 0x1.0p-53;
}

Cell varying_cell(const std::string& name, double nu, double expected_s, double (*dt_s)(std::size_t)) {
    PressCell cell;
    cell.dt_s = expected_s;
    cell.specimen = [=] { return plain_cube({kYoungsModulus_pa, nu, kDensity_kg_per_m3}); };
    cell.rescript = [=](const Specimen&, Script& script) { script.varying_dt_s = dt_s; };
    return press_cell("dt", fmt::format("{}, nu {}", name, nu), cell);
}

double jitter_20(std::size_t k) {
    return 1e-3 * (0.8 + 0.4 * draw(k));
}
double jitter_50(std::size_t k) {
    return 1e-3 * (0.5 + draw(k));
}
double anything(std::size_t k) {
    return kShortest_s * std::pow(kLongest_s / kShortest_s, draw(k));
}
double alternating(std::size_t k) {
    return k % 2 == 0 ? kShortest_s : kLongest_s;
}
double jumps(std::size_t k) {
    constexpr std::array<double, 3> kDts{kShortest_s, kLongest_s, 1e-3};
    return kDts[k / 100 % kDts.size()];
}

// ---- Outside of the range -------------------------------------------------------------------------------

/// Asked for such a step the runtime must refuse and stay as it is; the same time in allowed parts is then
/// run and judged as any other.
Cell out_of_range_cell(double dt_s, double part_s) {
    PressCell cell;
    cell.dt_s = part_s;
    cell.specimen = [] { return plain_cube(); };
    cell.demands.about = "refused";
    cell.also = [=](const Specimen& specimen, const Record&, CellResult& result) {
        Simulation simulation = simulation_of(specimen, config_for(specimen, part_s));
        Pose pose = simulation.tool_rest_pose();
        pose.position_m[2] -= 0.01 * kSide_m;
        (void)simulation.step(pose, part_s);
        const std::vector<double> before(simulation.positions_m(),
                                         simulation.positions_m() + 3 * simulation.node_count());
        const StepResult refused = simulation.step(pose, dt_s);
        const bool kept =
            std::memcmp(before.data(), simulation.positions_m(), before.size() * sizeof(double)) == 0;
        const bool honest = refused.status == kStepBadInput && refused.force_n == Vec3{} && kept;
        Check check = must_be("refused", honest,
                              "a step out of range was not refused as bad_input with no force "
                              "and the state as it was");
        if (honest) {
            check.status = CellStatus::warn;
            check.warning = Warning::dt_out_of_range;
            check.note = fmt::format("{} ms is refused; run as steps of {:.3g} ms", 1e3 * dt_s, 1e3 * part_s);
        }
        result.checks.insert(result.checks.begin(), check);
    };
    return press_cell("dt", fmt::format("{} ms, out of range", 1e3 * dt_s), cell);
}

}  // namespace

void add_time_step_cells(Cells& cells) {
    for (const double nu : {0.3, 0.49})
        for (const double dt_s : {0.25e-3, 0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3, 20e-3})
            cells.push_back(steady_cell(nu, dt_s, ToolContact::bonded));
    for (const double dt_s : {0.25e-3, 1e-3, 5e-3, 20e-3})
        cells.push_back(steady_cell(0.3, dt_s, ToolContact::frictionless));
    for (const double nu : {0.3, 0.49}) {
        cells.push_back(varying_cell("1 ms with 20 % jitter", nu, 1e-3, jitter_20));
        cells.push_back(varying_cell("1 ms with 50 % jitter", nu, 1e-3, jitter_50));
        cells.push_back(varying_cell("at random from 0.25 to 20 ms", nu, 1e-3, anything));
        cells.push_back(varying_cell("0.25 and 20 ms in turn", nu, 1e-3, alternating));
        cells.push_back(varying_cell("0.25, 20 and 1 ms for 100 steps each", nu, 1e-3, jumps));
    }
    cells.push_back(out_of_range_cell(0.1e-3, kShortest_s));
    cells.push_back(out_of_range_cell(50e-3, 50e-3 / 3));
}

}  // namespace knead::tools::stability
