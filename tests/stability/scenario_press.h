// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "material/scenario.h"
#include "reference/plate_press.h"
#include "support/kuhn_cube.h"

namespace knead::test {

inline constexpr double kCubeSideM = 0.1;
inline constexpr double kCubeDensityKgPerM3 = 1000;  // 1 kg
inline constexpr double kCubePoissonsRatio = 0.3;
inline constexpr std::uint64_t kCubeSeed = 1;
inline constexpr double kPressStrain = 0.1;

/// The paper's press: a cube of cells^3 under one of the nine scenarios, by a tenth of its height.
struct ScenarioPress {
    int scenario;
    std::uint32_t cells;
};

inline std::string name_of(const ScenarioPress& press) {
    return "scenario" + std::to_string(press.scenario) + "_n" + std::to_string(press.cells);
}

inline void PrintTo(const ScenarioPress& press, std::ostream* out) {
    *out << name_of(press);
}

/// All nine scenarios, and with more cells the first and the eighth.
inline std::vector<ScenarioPress> scenario_presses(std::uint32_t cells, std::uint32_t more_cells) {
    std::vector<ScenarioPress> presses;
    for (int scenario = tools::kFirstScenario; scenario <= tools::kLastScenario; ++scenario)
        presses.push_back({scenario, cells});
    presses.push_back({1, more_cells});
    presses.push_back({8, more_cells});
    return presses;
}

/// Its lowest nodes held, its highest under the plate.
struct PressedCube {
    explicit PressedCube(const ScenarioPress& which, double poissons_ratio = kCubePoissonsRatio)
        : mesh(kuhn_cube(which.cells, kCubeSideM)),
          material(
              tools::scenario_material(mesh, which.scenario, kCubeSeed, poissons_ratio, kCubeDensityKgPerM3)),
          press(tools::plate_press(mesh, kPressStrain)) {}
    /// Of the plate, down.
    [[nodiscard]] double way_m() const { return kPressStrain * press.height_m; }

    TetMesh mesh;
    Material material;
    tools::PlatePress press;
};

}  // namespace knead::test
