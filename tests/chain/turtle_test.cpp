// SPDX-License-Identifier: Apache-2.0
// A real object made by others: VegaFEM's turtle, two materials with different nu and a contrast of 100
// (J. Quandt, J. Barbic; CC BY-SA 3.0). The file has no unit: we call it centimetres. Not part of this
// repository: KNEAD_TURTLE names its .veg file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "chain/programs.h"
#include "knead/formats/read.h"
#include "knead/formats/write/write.h"
#include "knead/runtime/simulation.h"
#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

constexpr std::uint32_t kCells = 6;  // along each side of the box around the turtle

std::filesystem::path turtle_file() {
    const char* given = std::getenv("KNEAD_TURTLE");
    return given != nullptr ? given : KNEAD_TURTLE_DEFAULT "/turtle-volumetric-heterogeneous.veg";
}

/// Those cells of a grid around `fine` that hold the barycentre of one of its tetrahedra.
TetMesh cells_around(const TetMesh& fine) {
    Point low = fine.nodes_m[0], high = low;
    for (const Point& node : fine.nodes_m)
        for (std::size_t a = 0; a < 3; ++a)
            low[a] = std::min(low[a], node[a]), high[a] = std::max(high[a], node[a]);
    const Point size{high[0] - low[0], high[1] - low[1], high[2] - low[2]};
    TetMesh grid = kuhn_box(kCells, kCells, kCells, size);
    std::set<std::size_t> wanted;
    for (std::size_t i = 0; i < fine.tetrahedra.size(); ++i) {
        const Point centre = barycentre_m(fine, i);
        std::size_t cell = 0;
        for (const std::size_t a : {2, 1, 0})
            cell = cell * kCells +
                   std::min<std::size_t>(kCells - 1,
                                         static_cast<std::size_t>((centre[a] - low[a]) / size[a] * kCells));
        wanted.insert(cell);
    }
    TetMesh kept;
    std::vector<std::uint32_t> place(grid.nodes_m.size(), UINT32_MAX);
    for (std::size_t i = 0; i < grid.tetrahedra.size(); ++i) {
        if (wanted.count(i / 6) == 0) continue;
        Tetrahedron t = grid.tetrahedra[i];
        for (std::uint32_t& node : t) {
            if (place[node] == UINT32_MAX) {
                place[node] = static_cast<std::uint32_t>(kept.nodes_m.size());
                const Point& p = grid.nodes_m[node];
                kept.nodes_m.push_back({p[0] + low[0], p[1] + low[1], p[2] + low[2]});
            }
            node = place[node];
        }
        kept.tetrahedra.push_back(t);
    }
    return kept;
}

std::string scene_text(const std::filesystem::path& folder) {
    return "name = \"turtle\"\n"
           "[mesh]\nkind = \"file\"\nlength_unit = \"cm\"\nfile = \"" +
           turtle_file().string() +
           "\"\n"
           "[material]\nfrom_mesh = true\n"
           "[[level]]\nname = \"coarse\"\nmesh = { file = \"" +
           (folder / "coarse.msh").string() +
           "\", length_unit = \"m\" }\n"
           "[[held]]\nside = \"bottom\"\n"
           "[[tool]]\nname = \"finger\"\nshape = \"sphere\"\nradius = \"5mm\"\ncontact = \"frictionless\"\n"
           "touches = { side = \"all\" }\n";
}

/// A finger comes down on the highest node, presses it 2 mm and goes again.
void touch_and_leave(Simulation& simulation, const std::vector<Point>& nodes_m) {
    constexpr double kStepS = 1e-3;
    const Point highest = *std::max_element(nodes_m.begin(), nodes_m.end(),
                                            [](const Point& a, const Point& b) { return a[2] < b[2]; });
    Pose pose = simulation.tool_rest_pose();
    pose.position_m = {highest[0], highest[1], highest[2] + 0.006};
    double strongest_n = 0;
    StepResult step;
    for (int i = 0; i < 300; ++i) {
        pose.position_m[2] += i < 150 ? -2e-5 : 4e-5;
        step = simulation.step(pose, kStepS);
        EXPECT_EQ(step.status, kStepOk) << "step " << i;
        strongest_n = std::max(strongest_n, step.force_n[2]);
    }
    EXPECT_GT(strongest_n, 0.1);
    EXPECT_EQ(step.touched_nodes, 0u);
    EXPECT_EQ(step.force_n, (Vec3{0, 0, 0}));
}

class Turtle : public testing::Test {
  protected:
    void SetUp() override {
        if (!std::filesystem::exists(turtle_file()))
            GTEST_SKIP() << "the turtle is not here (" << turtle_file()
                         << "); set KNEAD_TURTLE to its .veg file";
        folder_ = fresh_folder();
    }
    void require_run(const std::string& command) {
        ASSERT_EQ(run_program(command, folder_ / "log"), 0) << command << '\n' << content_of(folder_ / "log");
    }
    std::filesystem::path folder_;
};

TEST_F(Turtle, Goes_through_the_whole_chain_and_is_felt) {
    const auto path = [&](const char* name) { return (folder_ / name).string(); };
    require_run("knead-mesh import " + turtle_file().string() + " --length-unit cm -o " + path("fine.hdf"));
    const auto fine = read_tet_mesh(folder_ / "fine.hdf");
    ASSERT_TRUE(fine.ok());
    EXPECT_EQ(fine.value().tetrahedra.size(), 1185u);
    EXPECT_EQ(fine.value().nodes_m.size(), 347u);
    ASSERT_TRUE(write_tet_mesh(folder_ / "coarse.hdf", cells_around(fine.value()), {}).ok());
    require_run("knead-asset export " + path("coarse.hdf") + " -o " + path("coarse.msh"));
    std::ofstream(folder_ / "turtle.toml") << scene_text(folder_);
    require_run("knead build " + path("turtle.toml") + " -o " + path("out"));

    const auto asset = read_asset(folder_ / "out/turtle.coarse.hdf");
    ASSERT_TRUE(asset.ok()) << asset.error().text();
    ASSERT_EQ(asset.value().palette.size(), 2u);
    const PaletteEntry& body = asset.value().palette[0];
    const PaletteEntry& shell = asset.value().palette[1];
    EXPECT_EQ(body.youngs_modulus_pa, 250000);
    EXPECT_EQ(body.poissons_ratio, 0.35);
    EXPECT_EQ(shell.youngs_modulus_pa, 25000000);
    EXPECT_EQ(shell.poissons_ratio, 0.45);
    EXPECT_EQ(shell.density_kg_per_m3, 1000);

    auto simulation = Simulation::load(folder_ / "out/turtle.coarse.hdf");
    ASSERT_TRUE(simulation.ok()) << simulation.error().text();
    touch_and_leave(simulation.value(), asset.value().nodes_m);
}

}  // namespace
}  // namespace knead::test
