// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The command line of knead-material: included by its main only.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "material/request.h"
#include "material/scenario.h"

namespace knead::tools {

/// What the command line says. Tables are still file names here; the main reads them into the request.
struct Arguments {
    std::filesystem::path mesh;
    std::filesystem::path output;
    std::vector<std::string> regions;
    std::filesystem::path region_table;
    std::filesystem::path csv;
    MaterialRequest request;
};

inline void declare_sources(CLI::App& app, Arguments& arguments) {
    MaterialRequest& request = arguments.request;
    CLI::App* source = app.add_option_group("Elasticity (exactly one)");
    source->add_option("--uniform", request.uniform_pa, "one Young's modulus everywhere, Pa")->type_name("E");
    source->add_option("--scenario", request.scenario, "one of the paper's nine layouts, drawn with --seed")
        ->check(CLI::Range(kFirstScenario, kLastScenario))
        ->type_name("N");
    source
        ->add_option("--region", arguments.regions,
                     "values of one region in Pa, -, kg/m^3; once for each region")
        ->allow_extra_args(false)
        ->type_name("NAME=E,NU,DENSITY");
    source->add_option("--region-table", arguments.region_table, "the same from a CSV: region,E,nu,density")
        ->type_name("FILE");
    source->add_option("--array", request.array, "Young's moduli in Pa from a cell array of the mesh")
        ->type_name("NAME");
    source->add_flag("--from-mesh", request.from_mesh,
                     "cell arrays youngs_modulus_pa and, if there, poissons_ratio and density_kg_per_m3");
    source->add_option("--csv", arguments.csv, "CSV with a line per tetrahedron: E, or E,nu,density")
        ->type_name("FILE");
    source->add_option("--expression", request.expression, "formula of x, y, z in metres that gives Pa")
        ->type_name("TEXT");
    source->require_option(1);
}

inline void declare(CLI::App& app, Arguments& arguments) {
    MaterialRequest& request = arguments.request;
    app.add_option("MESH", arguments.mesh, "tetrahedral mesh")->required()->group("Inputs");
    app.add_option("-o,--output", arguments.output,
                   "mesh with material to write; replaced only once complete")
        ->required()
        ->type_name("FILE");
    declare_sources(app, arguments);
    app.add_option("--poissons-ratio", request.poissons_ratio, "where the source has none [0.3]")
        ->type_name("NU");
    auto* density =
        app.add_option("--density", request.density_kg_per_m3, "kg/m^3, where the source has none [1000]")
            ->type_name("D");
    app.add_option("--total-mass", request.total_mass_kg,
                   "instead: the density with which all of it weighs this")
        ->type_name("KG")
        ->excludes(density);
}

}  // namespace knead::tools
