// SPDX-License-Identifier: Apache-2.0
#include "bench/scene.h"

#include <array>
#include <random>
#include <string>
#include <vector>

#include "material/scenario.h"
#include "support/kuhn_cube.h"

namespace knead::bench {
namespace {

constexpr double kSoftPa = 4000;
constexpr double kPercolatingShare = 0.5;
constexpr double kIslandShare = 0.05;
constexpr std::uint32_t kTetrahedraPerCell = 6;

/// Uniform in [0, 1), the same on every platform.
double draw(std::mt19937_64& engine) {
    return static_cast<double>(engine() >> 11U) * 0x1.0p-53;
}

std::vector<bool> percolating(std::size_t tetrahedra, std::mt19937_64& engine) {
    std::vector<bool> stiff(tetrahedra);
    for (std::size_t t = 0; t < tetrahedra; ++t)
        stiff[t] = draw(engine) < kPercolatingShare;
    return stiff;
}

/// Whole cells at odd places inside the cube, drawn until the share is reached or no place is left.
std::vector<bool> islands(std::uint32_t cells, std::mt19937_64& engine) {
    std::vector<std::uint32_t> places;
    for (std::uint32_t z = 1; z + 1 < cells; z += 2)
        for (std::uint32_t y = 1; y + 1 < cells; y += 2)
            for (std::uint32_t x = 1; x + 1 < cells; x += 2)
                places.push_back((z * cells + y) * cells + x);
    const std::uint32_t all = cells * cells * cells;
    std::size_t wanted = static_cast<std::size_t>(kIslandShare * all + 0.5);
    std::vector<bool> stiff(std::size_t{kTetrahedraPerCell} * all, false);
    for (; wanted > 0 && !places.empty(); --wanted) {
        const auto at = static_cast<std::size_t>(draw(engine) * static_cast<double>(places.size()));
        for (std::uint32_t k = 0; k < kTetrahedraPerCell; ++k)
            stiff[std::size_t{kTetrahedraPerCell} * places[at] + k] = true;
        places[at] = places.back();
        places.pop_back();
    }
    return stiff;
}

tools::Selection side(const std::string& name, const std::string& key) {
    tools::Selection selection;
    selection.side = name;
    selection.scene_key = key;
    return selection;
}

}  // namespace

MaterialObject scenario_cube(std::uint32_t cells, double poissons_ratio) {
    MaterialObject object;
    object.mesh = test::kuhn_cube(cells, kSideM);
    object.material = tools::scenario_material(object.mesh, 1, kSeed, poissons_ratio, kDensityKgPerM3);
    return object;
}

MaterialObject contrast_cube(std::uint32_t cells, double poissons_ratio, double contrast, Layout layout) {
    MaterialObject object;
    object.mesh = test::kuhn_cube(cells, kSideM);
    const std::size_t count = object.mesh.tetrahedra.size();
    std::mt19937_64 engine(kSeed);
    const std::vector<bool> stiff =
        layout == Layout::percolating ? percolating(count, engine) : islands(cells, engine);
    for (std::size_t t = 0; t < count; ++t)
        object.material.youngs_modulus_pa.push_back(stiff[t] ? kSoftPa * contrast : kSoftPa);
    object.material.poissons_ratio.assign(count, poissons_ratio);
    object.material.density_kg_per_m3.assign(count, kDensityKgPerM3);
    return object;
}

tools::Scene press_scene() {
    tools::Scene scene;
    scene.file = "bench.toml";
    scene.name = "cube";
    scene.held.push_back(side("bottom", "held[0]"));
    tools::SceneTool plate;
    plate.name = "plate";
    plate.touches = side("top", "tool[0].touches");
    scene.tools.push_back(plate);
    scene.levels.emplace_back();
    scene.levels.back().name = "fine";
    return scene;
}

Asset bake_scene(const tools::Scene& scene, const MaterialObject& object, const tools::Skin& skin) {
    return tools::bake(scene, scene.levels.front(), object, skin);
}

}  // namespace knead::bench
