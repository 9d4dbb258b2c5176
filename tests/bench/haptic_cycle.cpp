// SPDX-License-Identifier: Apache-2.0
#include "bench/haptic_cycle.h"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "bench/scene.h"
#include "knead/haptics/haptic_loop.h"

namespace knead::bench {
namespace {

constexpr double kPeriodS = 1e-3;
constexpr double kSimulationHz = 120;
constexpr double kDepthM = 0.01;
constexpr double kMotionHz = 1.5;
constexpr double kPi = 3.14159265358979323846;

struct Variant {
    const char* name;
    LocalRendering rendering;
    bool turns;
};
constexpr Variant kVariants[] = {{"reduced object", LocalRendering::reduced_object, false},
                                 {"reduced object, 6 dof", LocalRendering::reduced_object, true},
                                 {"linear", LocalRendering::linear, false},
                                 {"hold", LocalRendering::hold, false}};

/// Goes up and down across the surface.
class WavingDevice final : public Device {
  public:
    explicit WavingDevice(const Pose& rest) : rest_(rest) {}
    DeviceState read() noexcept override {
        DeviceState state;
        state.pose = rest_;
        state.time_s = kPeriodS * static_cast<double>(++reads_);
        state.pose.position_m[2] += kDepthM * (0.3 - std::sin(2 * kPi * kMotionHz * state.time_s));
        return state;
    }
    void write(const Vec3& /*force_n*/, const Vec3& /*torque_nm*/) noexcept override {}

  private:
    Pose rest_;
    int reads_ = 0;
};

template <class T>
T checked(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().text());
    return std::move(result).value();
}

HapticCycleRow measure(const Asset& asset, const Variant& variant, int ticks) {
    using Clock = std::chrono::steady_clock;
    HapticConfig config;
    config.mode = HapticMode::two_rate;
    config.rendering = variant.rendering;
    config.simulation_rate_hz = kSimulationHz;
    config.coupling.damping_n_s_per_m = 2;
    if (variant.turns) config.coupling.rotation_stiffness_nm_per_rad = 0.3;
    Simulation simulation = checked(Simulation::create(asset, simulation_config(config)));
    WavingDevice device(simulation.tool_rest_pose());
    HapticLoop loop = checked(HapticLoop::create(device, simulation, config));
    std::vector<double> us;
    int steps = 0;
    for (int i = 0; i < ticks; ++i) {
        const auto begin = Clock::now();
        (void)loop.tick(kPeriodS);
        us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
        if (i * kPeriodS * kSimulationHz < steps) continue;
        ++steps;
        loop.publish(loop.simulate(1 / kSimulationHz));
    }
    return {variant.name, ticks, baseline::percentiles(std::move(us))};
}

}  // namespace

std::vector<HapticCycleRow> measure_haptic_cycle(std::uint32_t cells, int ticks) {
    tools::Scene scene = press_scene();
    scene.tools.front().contact = ToolContact::sticking;
    const Asset asset = bake_scene(scene, scenario_cube(cells));
    std::vector<HapticCycleRow> rows;
    for (const Variant& variant : kVariants)
        rows.push_back(measure(asset, variant, ticks));
    return rows;
}

}  // namespace knead::bench
