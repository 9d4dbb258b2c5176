// SPDX-License-Identifier: Apache-2.0
#include "bench/leave_out.h"

#include <chrono>

#include "bench/loading.h"
#include "bench/motion.h"
#include "bench/scene.h"

namespace knead::bench {
namespace {

/// What is baked and how it is run.
struct Variant {
    tools::Scene scene = press_scene();
    tools::Skin skin;
    SimulationConfig config;
};

constexpr double kBallRadiusM = 0.03;
constexpr double kFriction = 0.5;
constexpr std::uint32_t kSkinCells = 40;  // finer than the tetrahedra

/// A square grid over the top of the cube.
void add_skin(Variant& v) {
    const std::uint32_t row = kSkinCells + 1;
    for (std::uint32_t k = 0; k < row * row; ++k)
        v.skin.vertices_m.push_back(
            {kSideM * (k % row) / kSkinCells, kSideM * (k / row) / kSkinCells, kSideM});
    for (std::uint32_t k = 0; k < kSkinCells * kSkinCells; ++k) {
        const std::uint32_t a = k / kSkinCells * row + k % kSkinCells;
        v.skin.triangles.push_back({a, a + 1, a + row});
        v.skin.triangles.push_back({a + 1, a + row + 1, a + row});
    }
    v.scene.embedding.emplace();
}

void put_ball(Variant& v) {
    tools::SceneTool& tool = v.scene.tools.front();
    tool.shape = ToolShape::sphere;
    tool.contact = ToolContact::coulomb;
    tool.radius_m = kBallRadiusM;
    tool.friction_coefficient = kFriction;
}

/// A thing that a scene or an application may ask for.
struct Feature {
    const char* name;
    void (*add)(Variant& variant);
    bool in_everything = true;  ///< false: takes the place of something
};
// One line for each.
constexpr Feature kFeatures[] = {
    {"gravity",
     [](Variant& v) {
         v.scene.gravity_m_per_s2 = {0, 0, -9.81};
     }},
    {"damping", [](Variant& v) { v.scene.damping_per_s = 1; }},
    {"surface", [](Variant& v) { v.scene.needs_surface = true; }},
    {"embedding", add_skin},
    {"torque", [](Variant& v) { v.config.with_torque = true; }},
    {"ball with friction", put_ball, false},
};

constexpr double kDtS = 1e-3;
constexpr double kPressS = 0.25;
constexpr int kSliceSteps = 50;
constexpr int kWarmUpSteps = 2;
constexpr int kLoadRepetitions = 1;

/// A scene that is being timed.
struct Runner {
    LeaveOutRow row;
    Simulation simulation;
    std::vector<double> us;
    int step = 0;

    void slice(const Motion& motion) {
        for (int k = 0; k < kSliceSteps; ++k) {
            if (step == 0) simulation.reset();
            const Pose pose = motion.pose(simulation.tool_rest_pose(), (step + 1) * kDtS);
            const auto start = std::chrono::steady_clock::now();
            (void)simulation.step(pose, kDtS);
            const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
            if (k >= kWarmUpSteps) us.push_back(took.count());
            step = (step + 1) * kDtS < motion.duration_s ? step + 1 : 0;
        }
    }
};

Runner make_runner(const std::string& name, const Variant& variant, const MaterialObject& object) {
    const Asset asset = bake_scene(variant.scene, object, variant.skin);
    const Loading loading = measure_loading(asset, kLoadRepetitions, variant.config);
    return {{name, loading.file_bytes, loading.simulation_bytes, {}},
            make_simulation(asset, variant.config),
            {},
            0};
}

}  // namespace

std::vector<LeaveOutRow> measure_leave_out(std::uint32_t cells, int steps) {
    const MaterialObject object = scenario_cube(cells);
    std::vector<Runner> runners;
    runners.push_back(make_runner("minimal", {}, object));
    Variant everything;
    for (const Feature& feature : kFeatures) {
        Variant variant;
        feature.add(variant);
        if (feature.in_everything) feature.add(everything);
        const char* const how = feature.in_everything ? "+ " : "with a ";
        runners.push_back(make_runner(std::string(how) + feature.name, variant, object));
    }
    runners.push_back(make_runner("all with +", everything, object));
    const Motion motion = press(0.1 * kSideM, 0.1, kPressS, 1.0);
    for (int done = 0; done < steps; done += kSliceSteps)
        for (Runner& runner : runners)
            runner.slice(motion);
    std::vector<LeaveOutRow> rows;
    for (Runner& runner : runners) {
        runner.row.us = baseline::percentiles(runner.us);
        rows.push_back(runner.row);
    }
    return rows;
}

}  // namespace knead::bench
