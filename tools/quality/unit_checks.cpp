// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "quality/gate.h"

namespace knead::tools {
namespace {

// Matter and objects as they are; outside of these a unit is nearly always wrong.
constexpr double kSoftestMatter_pa = 100;    ///< brain, fat and the softest gels: 100 to 1,000 Pa
constexpr double kStiffestMatter_pa = 2e12;  ///< diamond: 1.2e12 Pa
constexpr double kLightestMatter = 5;        ///< kg/m^3; foams: 5 to 100. Water in g/cm^3 would be 1
constexpr double kHeaviestMatter = 23e3;     ///< kg/m^3; osmium: 22,590
constexpr double kLightestObject_kg = 1e-6;  ///< the tested range, docs/stability.md
constexpr double kHeaviestObject_kg = 1e3;
/// Weight of a column of the object over its elasticity: the strain at its foot when it stands.
constexpr double kSaggingStrain = 0.2;

struct Matter {
    double softest_pa = 0, stiffest_pa = 0;
    double lightest = 0, heaviest = 0;  ///< kg/m^3
    double mass_kg = 0;
};

Matter matter_of(const Asset& asset) {
    Matter matter;
    for (std::size_t i = 0; i < asset.tetrahedra.size(); ++i) {
        const Tetrahedron& t = asset.tetrahedra[i];
        const PaletteEntry& entry = asset.palette[asset.palette_index[i]];
        if (i == 0) {
            matter.softest_pa = matter.stiffest_pa = entry.youngs_modulus_pa;
            matter.lightest = matter.heaviest = entry.density_kg_per_m3;
        }
        matter.softest_pa = std::min(matter.softest_pa, entry.youngs_modulus_pa);
        matter.stiffest_pa = std::max(matter.stiffest_pa, entry.youngs_modulus_pa);
        matter.lightest = std::min(matter.lightest, entry.density_kg_per_m3);
        matter.heaviest = std::max(matter.heaviest, entry.density_kg_per_m3);
        matter.mass_kg +=
            entry.density_kg_per_m3 * signed_volume_m3(asset.nodes_m[t[0]], asset.nodes_m[t[1]],
                                                       asset.nodes_m[t[2]], asset.nodes_m[t[3]]);
    }
    return matter;
}

void examine_size(const MeshQuality& mesh, Findings& findings) {
    const double extent_m = mesh.extent_m();
    if (extent_m > kLargestLikelyExtent_m)
        findings.push_back({true, "size-large", extent_m, "m",
                            fmt::format("the object is {:.3g} m across: this looks like millimetres called "
                                        "metres",
                                        extent_m),
                            "check length_unit in the scene's [mesh]"});
    if (extent_m < kSmallestLikelyExtent_m)
        findings.push_back(
            {true, "size-small", extent_m, "m",
             fmt::format("the object is {:.3g} m across: this looks like a unit converted twice", extent_m),
             "check length_unit in the scene's [mesh]"});
}

void examine_mass(const Matter& matter, Findings& findings) {
    if (matter.lightest < kLightestMatter || matter.heaviest > kHeaviestMatter) {
        const double odd = matter.lightest < kLightestMatter ? matter.lightest : matter.heaviest;
        findings.push_back({true, "density-odd", odd, "kg/m^3",
                            fmt::format("a density of {:.3g} kg/m^3 is outside of {:g} to {:g}: this looks "
                                        "like g/cm^3, or like a wrong length unit under total_mass_kg",
                                        odd, kLightestMatter, kHeaviestMatter),
                            "give density_kg_per_m3 in kg/m^3 (water: 1000)"});
    }
    if (matter.mass_kg < kLightestObject_kg || matter.mass_kg > kHeaviestObject_kg)
        findings.push_back({true, "mass-odd", matter.mass_kg, "kg",
                            fmt::format("what can move weighs {:.3g} kg; tested from {:g} to {:g} kg",
                                        matter.mass_kg, kLightestObject_kg, kHeaviestObject_kg),
                            "check the length unit first, then the density"});
}

void examine_elasticity(const Matter& matter, Findings& findings) {
    if (matter.softest_pa < kSoftestMatter_pa)
        findings.push_back({true, "youngs-modulus-low", matter.softest_pa, "Pa",
                            fmt::format("a Young's modulus of {:.3g} Pa is softer than the softest matter: "
                                        "this looks like kPa or MPa called Pa",
                                        matter.softest_pa),
                            "give Young's moduli in Pa (22 kPa: 22000)"});
    if (matter.stiffest_pa > kStiffestMatter_pa)
        findings.push_back(
            {true, "youngs-modulus-high", matter.stiffest_pa, "Pa",
             fmt::format("a Young's modulus of {:.3g} Pa is above diamond's: this looks like a "
                         "unit converted twice",
                         matter.stiffest_pa),
             "give Young's moduli in Pa (22 kPa: 22000)"});
}

/// Strain that gravity would cause in a column as high as the object is along it.
void examine_weight(const Asset& asset, const MeshQuality& mesh, const Matter& matter, Findings& findings) {
    const Point& g = asset.gravity_m_per_s2;
    double pressure_pa = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        pressure_pa +=
            matter.mass_kg / mesh.volume_m3 * std::abs(g[axis]) * (mesh.high_m[axis] - mesh.low_m[axis]);
    const double strain = pressure_pa / path_youngs_modulus_pa(asset);
    if (asset.free_node_count < asset.nodes_m.size() && strain > kSaggingStrain)
        findings.push_back(
            {true, "sags", strain, "",
             fmt::format("gravity alone strains the object by about {:.2g}: it collapses under "
                         "its own weight",
                         strain),
             "check the Young's moduli (in Pa), the density and gravity_m_per_s2"});
}

}  // namespace

Findings examine_units(const Asset& asset, const MeshQuality& mesh) {
    Findings findings;
    const Matter matter = matter_of(asset);
    examine_size(mesh, findings);
    examine_mass(matter, findings);
    examine_elasticity(matter, findings);
    examine_weight(asset, mesh, matter, findings);
    return findings;
}

}  // namespace knead::tools
