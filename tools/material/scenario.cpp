// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/scenario.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/error.h"
#include "material/random.h"

namespace knead::tools {
namespace {

struct Range {
    double low_pa;
    double high_pa;
};
constexpr Range kSoft{2e3, 6e3};
constexpr Range kStiff{38e3, 42e3};
constexpr Range kScenario9{4e3, 200e3};
/// Share of the kind that gives a zone its name.
constexpr double kMajority = 2.0 / 3.0;
/// Half the side of the central cube of scenarios 7 and 8, as a share of the box.
constexpr double kCentralHalfSide = 0.2;

/// Barycentre in the bounding box, each coordinate in [0, 1].
class RelativePosition {
  public:
    explicit RelativePosition(const TetMesh& mesh)
        : mesh_(mesh), low_(mesh.nodes_m[0]), high_(mesh.nodes_m[0]) {
        for (const Point& node : mesh.nodes_m)
            for (int axis = 0; axis < 3; ++axis) {
                low_[axis] = std::min(low_[axis], node[axis]);
                high_[axis] = std::max(high_[axis], node[axis]);
            }
    }
    Point operator()(std::size_t tetrahedron) const {
        Point position = barycentre_m(mesh_, tetrahedron);
        for (int axis = 0; axis < 3; ++axis)
            position[axis] = (position[axis] - low_[axis]) / (high_[axis] - low_[axis]);
        return position;
    }

  private:
    const TetMesh& mesh_;
    Point low_;
    Point high_;
};

/// Which of `parts` equal slabs along one axis a relative coordinate falls in.
int slab(double coordinate, int parts) {
    return std::clamp(static_cast<int>(std::floor(coordinate * parts)), 0, parts - 1);
}

bool is_central(const Point& position) {
    return std::all_of(position.begin(), position.end(),
                       [](double coordinate) { return std::abs(coordinate - 0.5) <= kCentralHalfSide; });
}

/// Index of the zone at a relative position, and how many zones there are and which of them are stiff.
struct Layout {
    std::vector<bool> zone_is_stiff;
    int (*zone_at)(const Point& position);
};

Layout layout_of(int scenario) {
    constexpr auto kHalves = [](const Point& position) { return slab(position[2], 2); };
    constexpr auto kColumns = [](const Point& position) { return slab(position[0], 3); };
    constexpr auto kLayers = [](const Point& position) { return slab(position[2], 3); };
    constexpr auto kCentre = [](const Point& position) { return is_central(position) ? 1 : 0; };
    switch (scenario) {
        case 1:
            return {{false, true}, kHalves};
        case 2:
            return {{true, false}, kHalves};
        case 3:
            return {{true, false, true}, kColumns};
        case 4:
            return {{false, true, false}, kColumns};
        case 5:
            return {{false, true, false}, kLayers};
        case 6:
            return {{true, false, true}, kLayers};
        case 7:
            return {{true, false}, kCentre};
        case 8:
            return {{false, true}, kCentre};
        default:
            fail_usage("scenario " + std::to_string(scenario) + " has no zones (only 1 to 8 have)");
    }
}

void fill_zone(const ScenarioZone& zone, Random& random, std::vector<double>& youngs_modulus_pa) {
    std::vector<bool> stiff(zone.tetrahedra.size(), false);
    std::vector<std::uint32_t> order(zone.tetrahedra.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[i] = i;
    random.shuffle(order);
    for (std::size_t i = 0; i < stiff_count(zone); ++i)
        stiff[order[i]] = true;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Range& range = stiff[i] ? kStiff : kSoft;
        youngs_modulus_pa[zone.tetrahedra[i]] = random.uniform(range.low_pa, range.high_pa);
    }
}

}  // namespace

std::vector<ScenarioZone> scenario_zones(const TetMesh& mesh, int scenario) {
    const Layout layout = layout_of(scenario);
    const RelativePosition relative_position(mesh);
    std::vector<ScenarioZone> zones(layout.zone_is_stiff.size());
    for (std::size_t zone = 0; zone < zones.size(); ++zone)
        zones[zone].stiff = layout.zone_is_stiff[zone];
    for (std::uint32_t tetrahedron = 0; tetrahedron < mesh.tetrahedra.size(); ++tetrahedron)
        zones[layout.zone_at(relative_position(tetrahedron))].tetrahedra.push_back(tetrahedron);
    std::erase_if(zones, [](const ScenarioZone& zone) { return zone.tetrahedra.empty(); });
    return zones;
}

std::size_t stiff_count(const ScenarioZone& zone) {
    const double share = zone.stiff ? kMajority : 1.0 - kMajority;
    return static_cast<std::size_t>(std::llround(share * static_cast<double>(zone.tetrahedra.size())));
}

Material scenario_material(const TetMesh& mesh, int scenario, std::uint64_t seed, double poissons_ratio,
                           double density_kg_per_m3) {
    if (scenario < kFirstScenario || scenario > kLastScenario)
        fail_usage("scenario " + std::to_string(scenario) + " does not exist: there are scenarios 1 to 9");
    const std::size_t count = mesh.tetrahedra.size();
    Material material;
    material.youngs_modulus_pa.resize(count);
    material.poissons_ratio.assign(count, poissons_ratio);
    material.density_kg_per_m3.assign(count, density_kg_per_m3);
    Random random(seed);
    if (scenario == kLastScenario) {
        for (double& modulus : material.youngs_modulus_pa)
            modulus = random.uniform(kScenario9.low_pa, kScenario9.high_pa);
        return material;
    }
    for (const ScenarioZone& zone : scenario_zones(mesh, scenario))
        fill_zone(zone, random, material.youngs_modulus_pa);
    return material;
}

}  // namespace knead::tools
