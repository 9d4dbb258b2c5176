// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/input.h"
#include "common/run_tool.h"
#include "common/stopwatch.h"
#include "knead/formats/write/write.h"
#include "material/csv.h"
#include "material/expression.h"
#include "material/options.h"
#include "material/request.h"

namespace knead::tools {
namespace {

using Inputs = decltype(Provenance::inputs);

std::string read_text(ToolContext& context, const std::filesystem::path& file, const char* role,
                      Inputs& inputs) {
    Input<std::string> text = read_input_bytes(context, file);
    if (text.value.empty()) fail_input(file.string() + ": is empty");
    inputs.emplace_back(role, text.content_hash);
    return std::move(text.value);
}

void read_tables(ToolContext& context, Arguments& arguments, Inputs& inputs) {
    if (!arguments.regions.empty()) arguments.request.regions.emplace();
    for (const std::string& region : arguments.regions)
        arguments.request.regions->push_back(parse_region_option(region));
    if (!arguments.region_table.empty()) {
        const std::string text = read_text(context, arguments.region_table, "region_table", inputs);
        arguments.request.regions = about(arguments.region_table, [&] { return parse_region_csv(text); });
    }
    if (!arguments.csv.empty()) {
        const std::string text = read_text(context, arguments.csv, "csv", inputs);
        arguments.request.table = about(arguments.csv, [&] { return parse_value_csv(text); });
    }
}

void report(const ToolContext& context, const Arguments& arguments, const MaterialObject& object,
            double seconds) {
    const auto& moduli = object.material.youngs_modulus_pa;
    const auto [low, high] = std::minmax_element(moduli.begin(), moduli.end());
    double mass_kg = 0;
    for (std::size_t i = 0; i < moduli.size(); ++i)
        mass_kg += signed_volume_m3(object.mesh, i) * object.material.density_kg_per_m3[i];
    context.tell(fmt::format("{}: {} tetrahedra, E from {:.6g} to {:.6g} Pa, {:.6g} kg",
                             arguments.output.string(), moduli.size(), *low, *high, mass_kg));
    const nlohmann::ordered_json report{{"tetrahedra", moduli.size()},
                                        {"lowest_youngs_modulus_pa", *low},
                                        {"highest_youngs_modulus_pa", *high},
                                        {"mass_kg", mass_kg},
                                        {"seconds", {{"total", seconds}}}};
    context.write_report(report.dump(2) + "\n");
}

ExitCode run(ToolContext& context, Arguments& arguments) {
    const Stopwatch total;
    require_writable_folder(arguments.output);
    context.set_output(arguments.output);
    Input<TetMesh> mesh = read_input<TetMesh>(context, arguments.mesh);
    Inputs inputs{{"mesh", mesh.content_hash}};
    MaterialObject object{std::move(mesh.value), {}};
    read_tables(context, arguments, inputs);
    arguments.request.seed = context.seed;
    const auto& blamed = !arguments.csv.empty()            ? arguments.csv
                         : !arguments.region_table.empty() ? arguments.region_table
                                                           : arguments.mesh;
    MaterialAnswer answer = about(blamed, [&] { return make_material(object.mesh, arguments.request); });
    object.material = std::move(answer.material);

    Provenance provenance = context.provenance(answer.canonical_arguments);
    if (!answer.used_seed) provenance.seed = 0;
    provenance.inputs = std::move(inputs);
    value_or_throw(write_material(arguments.output, object, provenance));
    report(context, arguments, object, total.seconds());
    return ExitCode::done;
}

}  // namespace
}  // namespace knead::tools

int main(int argc, char** argv) {
    using namespace knead::tools;
    Arguments arguments;
    const ToolInfo info{
        .name = "knead-material",
        .purpose = "attach elasticity, Poisson's ratio and density to each tetrahedron.",
        .example = "knead-material cube.mesh.hdf --scenario 1 --total-mass 1 -o cube.material.hdf",
        .libraries = {expression_library()},
        .uses_seed = true};
    return run_tool(
        argc, argv, info, [&](CLI::App& app) { declare(app, arguments); },
        [&](ToolContext& context) { return run(context, arguments); });
}
