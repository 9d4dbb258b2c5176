// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "common/error.h"

namespace knead::tools {
namespace {

/// Levenshtein: the fewest letters to insert, delete or replace.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

const std::string& nearest_name(const std::string& name, const std::vector<std::string>& known) {
    return *std::min_element(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
        return edit_distance(name, a) < edit_distance(name, b);
    });
}

[[noreturn]] void refuse_name(const char* what, const std::string& name,
                              const std::vector<std::string>& known) {
    if (known.empty()) fail_input(fmt::format("the mesh has no {} \"{}\": it has none at all", what, name));
    fail_input(fmt::format("the mesh has no {} \"{}\"; did you mean \"{}\"? (it has: {})", what, name,
                           nearest_name(name, known), fmt::join(known, ", ")));
}

const std::vector<double>* find_array(const TetMesh& mesh, const std::string& name) {
    for (const CellArray& array : mesh.cell_arrays)
        if (array.name == name) return &array.values;
    return nullptr;
}

/// The values given for each region of the mesh.
std::vector<const RegionValues*> match_regions(const Regions& regions,
                                               const std::vector<RegionValues>& values) {
    std::vector<const RegionValues*> of_region(regions.names.size(), nullptr);
    for (const RegionValues& given : values) {
        const auto found = std::find(regions.names.begin(), regions.names.end(), given.region);
        if (found == regions.names.end()) refuse_name("region", given.region, regions.names);
        const RegionValues*& slot = of_region[static_cast<std::size_t>(found - regions.names.begin())];
        if (slot != nullptr) fail_input(fmt::format("region \"{}\" is given twice", given.region));
        slot = &given;
    }
    std::vector<std::string> missing;
    for (std::size_t region = 0; region < of_region.size(); ++region)
        if (of_region[region] == nullptr) missing.push_back(regions.names[region]);
    if (!missing.empty())
        fail_input(fmt::format("{} of {} regions have no values: {}", missing.size(), of_region.size(),
                               fmt::join(missing, ", ")));
    return of_region;
}

}  // namespace

Material uniform_material(const TetMesh& mesh, double youngs_modulus_pa, const MaterialDefaults& defaults) {
    Material material;
    material.youngs_modulus_pa.assign(mesh.tetrahedra.size(), youngs_modulus_pa);
    material.poissons_ratio.assign(mesh.tetrahedra.size(), defaults.poissons_ratio);
    material.density_kg_per_m3.assign(mesh.tetrahedra.size(), defaults.density_kg_per_m3);
    return material;
}

Material material_of_regions(const TetMesh& mesh, const std::vector<RegionValues>& values) {
    if (mesh.regions.region_of_tetrahedron.empty()) fail_input("the mesh has no regions");
    const auto of_region = match_regions(mesh.regions, values);
    Material material;
    for (const std::uint32_t region : mesh.regions.region_of_tetrahedron) {
        material.youngs_modulus_pa.push_back(of_region[region]->youngs_modulus_pa);
        material.poissons_ratio.push_back(of_region[region]->poissons_ratio);
        material.density_kg_per_m3.push_back(of_region[region]->density_kg_per_m3);
    }
    return material;
}

Material material_of_array(const TetMesh& mesh, const std::string& name, const MaterialDefaults& defaults) {
    const std::vector<double>* values = find_array(mesh, name);
    if (values == nullptr) {
        std::vector<std::string> known;
        for (const CellArray& array : mesh.cell_arrays)
            known.push_back(array.name);
        refuse_name("cell array", name, known);
    }
    return material_of_table(mesh, {*values, {}, {}}, defaults);
}

Material material_of_mesh(const TetMesh& mesh, const MaterialDefaults& defaults) {
    Material material = material_of_array(mesh, kYoungsModulusArray, defaults);
    if (const auto* values = find_array(mesh, kPoissonsRatioArray)) material.poissons_ratio = *values;
    if (const auto* values = find_array(mesh, kDensityArray)) material.density_kg_per_m3 = *values;
    return material;
}

Material material_of_table(const TetMesh& mesh, const ValueTable& table, const MaterialDefaults& defaults) {
    const std::size_t count = mesh.tetrahedra.size();
    if (table.youngs_modulus_pa.size() != count)
        fail_input(fmt::format("{} rows for {} tetrahedra: there must be exactly one for each",
                               table.youngs_modulus_pa.size(), count));
    Material material = uniform_material(mesh, 0, defaults);
    material.youngs_modulus_pa = table.youngs_modulus_pa;
    if (!table.poissons_ratio.empty()) material.poissons_ratio = table.poissons_ratio;
    if (!table.density_kg_per_m3.empty()) material.density_kg_per_m3 = table.density_kg_per_m3;
    return material;
}

void set_total_mass(const TetMesh& mesh, double total_mass_kg, Material& material) {
    double volume_m3 = 0;
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i)
        volume_m3 += signed_volume_m3(mesh, i);
    material.density_kg_per_m3.assign(mesh.tetrahedra.size(), total_mass_kg / volume_m3);
}

}  // namespace knead::tools
