// SPDX-License-Identifier: Apache-2.0
// The smallest haptic application: an asset, a device, a loop. Needs the installed runtime and nothing else.
#include <cstdio>

#include "knead/haptics/haptic_loop.h"
#include "knead/haptics/scripted_device.h"
#include "knead/runtime/simulation.h"

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "Usage: haptic_loop ASSET\n");
        return 2;
    }
    const knead::HapticConfig config;
    auto simulation = knead::Simulation::load(argv[1], knead::simulation_config(config));
    if (!simulation) {
        std::fprintf(stderr, "haptic_loop: error: %s\n", simulation.error().text().c_str());
        return 3;
    }

    // A hand that presses 5 mm against the tool's face and comes back. Put your device's adapter here.
    knead::PressScript script;
    script.start = simulation.value().tool_rest_pose();
    script.travel_m = {0, 0, -0.005};
    script.press_s = 0.5;
    script.hold_s = 0.3;
    script.release_s = 0.5;
    script.rest_s = 0.1;
    knead::ScriptedDevice device(knead::press_samples(script));

    auto loop = knead::HapticLoop::create(device, simulation.value(), config);
    if (!loop) {
        std::fprintf(stderr, "haptic_loop: error: %s\n", loop.error().text().c_str());
        return 3;
    }
    std::printf("  time s  depth mm   force N\n");
    std::uint64_t tick_count = 0;
    const auto run = loop.value().run(device.samples().back().time_s, [&](const knead::HapticTick& tick) {
        if (++tick_count % 100 != 0) return;
        const double depth_mm = 1e3 * (script.start.position_m[2] - tick.step.tool_position_m[2]);
        std::printf("%8.3f  %8.3f  %8.4f%s\n", tick.device.time_s, depth_mm, tick.device_force_n[2],
                    (tick.status & knead::kHapticSaturated) != 0 ? "  (the device's limit)" : "");
    });
    if (!run) {
        std::fprintf(stderr, "haptic_loop: error: %s\n", run.error().text().c_str());
        return 3;
    }
    std::printf("%llu ticks, %llu late, longest %.0f us\n",
                static_cast<unsigned long long>(run.value().ticks),
                static_cast<unsigned long long>(run.value().misses), 1e6 * run.value().longest_tick_s);
    return (run.value().step_status & (knead::kStepNotFinite | knead::kStepBadInput)) == 0 ? 0 : 1;
}
