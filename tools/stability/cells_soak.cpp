// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stability/cells.h"
#include "stability/criteria.h"
#include "stability/meshes.h"

namespace knead::tools::stability {
namespace {

// A hand that presses and trembles: 10 Hz, and along the other axes 8 and 12 Hz: all repeats within half a
// second.
constexpr double kPressed = 0.1, kTremor_m = 0.3e-3, kSideTremor_m = 0.1e-3;
constexpr double kTremor_hz = 10, kSideTremorX_hz = 8, kSideTremorY_hz = 12;
/// The press and what it leaves vibrating, before the steady part begins.
constexpr double kPress_s = 2;

double tremor(double amplitude_m, double frequency_hz, double time_s) {
    return amplitude_m * std::sin(2 * M_PI * std::fmod(frequency_hz * time_s, 1.0));
}

Cell soak_cell(const std::string& name, double dt_s, double share,
               const std::function<Specimen()>& specimen) {
    return {"soak", fmt::format("{}, dt {} ms", name, 1e3 * dt_s),
            [=](const StabilityRequest& request, CellResult& result) {
                const Specimen object = specimen();
                const auto steps = static_cast<std::uint64_t>(
                    std::max(1.0, share * static_cast<double>(request.soak_steps)));
                Script script;
                script.dt_s = dt_s;
                script.steady_s = std::min(kPress_s, 0.1 * static_cast<double>(steps) * dt_s);
                script.end_s = (static_cast<double>(steps) + 0.5) * dt_s;
                script.still_s = script.leave_s = script.released_s = script.end_s;
                const double press_s = 0.5 * script.steady_s;
                script.move = [=](double time_s, std::vector<Pose>& poses) {
                    for (Pose& pose : poses) {
                        pose.position_m[0] += tremor(kSideTremor_m, kSideTremorX_hz, time_s);
                        pose.position_m[1] += tremor(kSideTremor_m, kSideTremorY_hz, time_s);
                        pose.position_m[2] += tremor(kTremor_m, kTremor_hz, time_s) -
                                              kPressed * kSide_m * std::min(1.0, time_s / press_s);
                    }
                };
                RunOptions options;
                options.config = config_for(object, dt_s);
                options.force_at_rest = false;
                options.most_steps = steps;
                const Record record = run(object, script, options);
                Demands demands;
                demands.about = "force_growth";
                demands.forces = demands.force_at_rest = demands.recovery = false;
                demands.soak = true;
                demands.contact_law = object.asset.tools[0].contact != ToolContact::bonded;
                result.checks = judge(record, demands, object.size_m);
                result.steps = record.steps;
            }};
}

Specimen under(const MaterialObject& object, const SceneTool& tool) {
    Setting setting;
    setting.tools = {tool};
    setting.damped = false;
    return make_specimen(object, setting);
}

MaterialObject cube(std::uint32_t cells) {
    return homogeneous(box_mesh({cells, cells, cells}, {kSide_m, kSide_m, kSide_m}));
}

}  // namespace

void add_soak_cells(Cells& cells) {
    cells.push_back(soak_cell("1,296 tetrahedra, contrast 10, bonded plate", 1e-3, 1, [] {
        return under(contrast_cube(6, kSide_m, kPoissonsRatio, 10, Layout::percolating), bonded_plate());
    }));
    // Shorter ones beside it: a tenth of the steps.
    cells.push_back(soak_cell("384 tetrahedra, Coulomb ball", 1e-3, 0.1, [] {
        return under(cube(4), tool_above(ToolShape::sphere, ToolContact::coulomb));
    }));
    cells.push_back(soak_cell("384 tetrahedra, sticking plate", 0.25e-3, 0.25, [] {
        return under(cube(4), tool_above(ToolShape::plate, ToolContact::sticking));
    }));
    cells.push_back(soak_cell("islands 1e6, bonded plate", 1e-3, 0.1, [] {
        return under(contrast_cube(5, kSide_m, kPoissonsRatio, 1e6, Layout::islands), bonded_plate());
    }));
    cells.push_back(soak_cell("384 tetrahedra, nu 0.49, bonded plate", 10e-3, 0.1, [] {
        return under(homogeneous(box_mesh({4, 4, 4}, {kSide_m, kSide_m, kSide_m}),
                                 {kYoungsModulus_pa, 0.49, kDensity_kg_per_m3}),
                     bonded_plate());
    }));
}

}  // namespace knead::tools::stability
