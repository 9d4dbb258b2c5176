// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/request.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.h"
#include "material/checks.h"
#include "material/expression.h"
#include "material/scenario.h"

namespace knead::tools {
namespace {

/// A material and what of it the source itself gave.
struct Sourced {
    Material material;
    std::vector<std::string> canonical;
    bool gives_poissons_ratio = false;
    bool gives_density = false;
};

bool has_array(const TetMesh& mesh, const char* name) {
    return std::any_of(mesh.cell_arrays.begin(), mesh.cell_arrays.end(),
                       [name](const CellArray& array) { return array.name == name; });
}

Sourced from_regions(const TetMesh& mesh, const std::vector<RegionValues>& regions) {
    Sourced sourced{material_of_regions(mesh, regions), {}, true, true};
    for (const RegionValues& values : regions) {
        sourced.canonical.emplace_back("--region");
        sourced.canonical.push_back(fmt::format("{}={},{},{}", values.region, values.youngs_modulus_pa,
                                                values.poissons_ratio, values.density_kg_per_m3));
    }
    return sourced;
}

Sourced from_table(const TetMesh& mesh, const ValueTable& table, const MaterialDefaults& defaults) {
    const bool all = !table.poissons_ratio.empty();
    return {material_of_table(mesh, table, defaults), {"--csv", all ? "E,nu,density" : "E"}, all, all};
}

Sourced from_source(const TetMesh& mesh, const MaterialRequest& request, const MaterialDefaults& defaults) {
    if (request.uniform_pa)
        return {uniform_material(mesh, *request.uniform_pa, defaults),
                {"--uniform", fmt::format("{}", *request.uniform_pa)}};
    if (request.scenario)
        return {scenario_material(mesh, *request.scenario, request.seed, defaults.poissons_ratio,
                                  defaults.density_kg_per_m3),
                {"--scenario", std::to_string(*request.scenario)}};
    if (request.regions) return from_regions(mesh, *request.regions);
    if (request.array)
        return {material_of_array(mesh, *request.array, defaults), {"--array", *request.array}};
    if (request.from_mesh)
        return {material_of_mesh(mesh, defaults),
                {"--from-mesh"},
                has_array(mesh, kPoissonsRatioArray),
                has_array(mesh, kDensityArray)};
    if (request.table) return from_table(mesh, *request.table, defaults);
    if (request.expression)
        return {material_of_table(mesh, {evaluate_expression(mesh, *request.expression), {}, {}}, defaults),
                {"--expression", *request.expression}};
    fail_usage("no source of elasticities is given");
}

void require_value(const char* option, const std::optional<double>& value,
                   std::optional<std::string> (*why_not)(double)) {
    if (!value) return;
    if (const auto reason = why_not(*value)) fail_usage(fmt::format("{} {} is {}", option, *value, *reason));
}

void require_request(const MaterialRequest& request) {
    require_value("--uniform", request.uniform_pa, why_not_positive);
    require_value("--poissons-ratio", request.poissons_ratio, why_not_poissons_ratio);
    require_value("--density", request.density_kg_per_m3, why_not_positive);
    require_value("--total-mass", request.total_mass_kg, why_not_positive);
    if (request.density_kg_per_m3 && request.total_mass_kg)
        fail_usage("--total-mass is another way to say --density: give one of them");
}

/// A default that the source overrules would be ignored without a word: refused instead.
void require_used(const char* option, bool given, bool overruled) {
    if (given && overruled) fail_usage(fmt::format("{} is of no use: the source has its own values", option));
}

}  // namespace

MaterialAnswer make_material(const TetMesh& mesh, const MaterialRequest& request) {
    require_request(request);
    MaterialDefaults defaults;
    defaults.poissons_ratio = request.poissons_ratio.value_or(defaults.poissons_ratio);
    defaults.density_kg_per_m3 = request.density_kg_per_m3.value_or(defaults.density_kg_per_m3);
    Sourced sourced = from_source(mesh, request, defaults);
    require_used("--poissons-ratio", request.poissons_ratio.has_value(), sourced.gives_poissons_ratio);
    require_used("--density", request.density_kg_per_m3.has_value(), sourced.gives_density);
    require_used("--total-mass", request.total_mass_kg.has_value(), sourced.gives_density);

    const auto note = [&](const char* option, double value) {
        sourced.canonical.emplace_back(option);
        sourced.canonical.push_back(fmt::format("{}", value));
    };
    if (!sourced.gives_poissons_ratio) note("--poissons-ratio", defaults.poissons_ratio);
    if (request.total_mass_kg) {
        set_total_mass(mesh, *request.total_mass_kg, sourced.material);
        note("--total-mass", *request.total_mass_kg);
    } else if (!sourced.gives_density) {
        note("--density", defaults.density_kg_per_m3);
    }
    require_physical(sourced.material);
    return {std::move(sourced.material), std::move(sourced.canonical), request.scenario.has_value()};
}

}  // namespace knead::tools
