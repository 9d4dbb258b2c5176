// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <string>

#include "stability/scenario_press.h"
#include "unit/reference/uniform_material.h"

namespace knead::tools {
namespace {

constexpr std::uint32_t kCells = 10;
constexpr std::size_t kSeeds = 5;
// The press of this cube at 22 kPa, from two programs of other authors (docs/reference.md).
constexpr double kHomogeneousN = 23.51532;
constexpr double kHomogeneousPa = 22000;
constexpr double kPrintedDigits = 1e-6;
// What the issue asks for: the table's own figures are means over five other draws.
constexpr double kForceTolerance = 0.05;
constexpr double kHomogenisedTolerancePoints = 2;

/// A row of the table: ours as published in docs/reference.md, and the paper's Table 2 beside it.
struct Row {
    int scenario;
    double force_n, paper_force_n;
    double homogenised_percent, paper_homogenised_percent;
};

void PrintTo(const Row& row, std::ostream* out) {
    *out << "scenario " << row.scenario;
}

constexpr std::array<Row, 9> kTable{{{1, 19.79, 20.71, 18.9, 19.6},
                                     {2, 19.74, 20.82, 18.5, 17.6},
                                     {3, 24.13, 25.09, 6.3, 9.6},
                                     {4, 19.46, 19.85, 9.3, 6.5},
                                     {5, 18.48, 18.97, 15.5, 16.2},
                                     {6, 22.21, 22.60, 15.2, 16.7},
                                     {7, 27.33, 27.90, 6.2, 6.3},
                                     {8, 15.82, 16.52, 13.1, 13.0},
                                     {9, 105.9, 107.7, 3.3, 3.4}}};

struct Spread {
    double mean = 0, deviation = 0, lowest = 0, highest = 0;
};

Spread spread_of(const std::array<double, kSeeds>& values) {
    Spread spread;
    for (const double value : values)
        spread.mean += value / kSeeds;
    for (const double value : values)
        spread.deviation += (value - spread.mean) * (value - spread.mean);
    spread.deviation = std::sqrt(spread.deviation / (kSeeds - 1));
    spread.lowest = *std::min_element(values.begin(), values.end());
    spread.highest = *std::max_element(values.begin(), values.end());
    return spread;
}

/// Volume-weighted mean over the whole mesh.
double mean_youngs_modulus_pa(const TetMesh& mesh, const Material& material) {
    double weighted = 0;
    double volume = 0;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        weighted += signed_volume_m3(mesh, t) * material.youngs_modulus_pa[t];
        volume += signed_volume_m3(mesh, t);
    }
    return weighted / volume;
}

double press_force_n(const TetMesh& mesh, const Material& material) {
    const PlatePress press = plate_press(mesh, test::kPressStrain);
    return force_on_plate_n(press, StaticProblem(mesh, material).solve(press.motion))[2];
}

class ScenarioReference : public testing::TestWithParam<Row> {};

TEST_P(ScenarioReference, Press_of_five_seeds_gives_the_published_force_and_homogenised_error) {
    const Row& row = GetParam();
    const TetMesh mesh = test::kuhn_cube(kCells);
    std::array<double, kSeeds> force_n{};
    std::array<double, kSeeds> homogenised_percent{};
    // With one Poisson's ratio the force of a homogeneous body is proportional to its elasticity; the tests
    // of plate_press show it, so one known press serves all homogenised bodies.
    tbb::parallel_for(std::size_t{0}, kSeeds, [&](std::size_t k) {
        const Material material =
            scenario_material(mesh, row.scenario, k + 1, test::kCubePoissonsRatio, test::kCubeDensityKgPerM3);
        force_n[k] = press_force_n(mesh, material);
        const double homogenised_n = kHomogeneousN * mean_youngs_modulus_pa(mesh, material) / kHomogeneousPa;
        homogenised_percent[k] = 100 * (homogenised_n / force_n[k] - 1);
    });
    const Spread force = spread_of(force_n);
    const Spread homogenised = spread_of(homogenised_percent);
    std::printf("| %d | %.2f +- %.2f (%.2f to %.2f) | %.2f | %+.1f +- %.1f | %.1f |\n", row.scenario,
                force.mean, force.deviation, force.lowest, force.highest, row.paper_force_n, homogenised.mean,
                homogenised.deviation, row.paper_homogenised_percent);
    EXPECT_NEAR(force.mean, row.force_n, kForceTolerance * row.force_n);
    EXPECT_NEAR(homogenised.mean, row.homogenised_percent, kHomogenisedTolerancePoints);
}

INSTANTIATE_TEST_SUITE_P(All, ScenarioReference, testing::ValuesIn(kTable), [](const auto& row) {
    return std::string("scenario").append(std::to_string(row.param.scenario));
});

TEST(HomogenisedReference, Homogenised_press_solved_outright_is_the_known_press_in_proportion) {
    const test::PressedCube cube({1, kCells});
    const double mean_pa = mean_youngs_modulus_pa(cube.mesh, cube.material);
    const double force_n =
        press_force_n(cube.mesh, test::uniform_material(cube.mesh, mean_pa, test::kCubePoissonsRatio));
    EXPECT_NEAR(force_n, kHomogeneousN * mean_pa / kHomogeneousPa, kPrintedDigits * force_n);
}

}  // namespace
}  // namespace knead::tools
